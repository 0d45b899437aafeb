// The group "ratios": times and errors of the other contestants relative to the library's.
//
// What belongs here: the pairs of rows. What does not: measuring.
#include "groups.hpp"

namespace crankloop::program::bench {
namespace {

class Ratios {
 public:
  explicit Ratios(const std::vector<Row>& rows) : rows_{rows} {}

  [[nodiscard]] const Row& row(const char* group, const char* contestant, const char* setting,
                               const char* real = "float") const {
    return find(rows_, group, contestant, real, setting);
  }
  /// With the setting, the time and the error of the library's row.
  void add(const std::string& what, double ratio, const Row& library) {
    Row row = library;
    row.group = "ratios";
    row.contestant = what;
    row.ratio = ratio;
    out_.push_back(std::move(row));
  }
  [[nodiscard]] std::vector<Row> take() { return std::move(out_); }

 private:
  const std::vector<Row>& rows_;
  std::vector<Row> out_;
};

void add_kinematics(Ratios& r) {
  const Row& library = r.row("kinematics", "library", "1 deg");
  const Row& linear = r.row("kinematics", "linear", "1 deg");
  const Row& libm = r.row("kinematics", "libm sin/cos/sqrt", "exact", "double");
  r.add("kinematics: time of libm in double to the library's", libm.ns_median / library.ns_median, library);
  r.add("kinematics: time of linear tables to the library's", linear.ns_median / library.ns_median, library);
  r.add("kinematics: error of linear tables to the library's", linear.error / library.error, library);
}

void add_valve(Ratios& r) {
  const Row& textbook = r.row("valve", "textbook RK4", "12000 rpm, 10 us");
  for (const char* method : {"located exponential", "located RK4"}) {
    const Row& library = r.row("valve", method, "12000 rpm, 10 us");
    const std::string to = std::string("textbook RK4 to ") + method;
    r.add("bouncing valve: time of " + to, textbook.ns_median / library.ns_median, library);
    r.add("bouncing valve: error of " + to, textbook.error / library.error, library);
  }
}

void add_ticks(Ratios& r) {
  const char* eight = "4 cylinders, 8 valves, 6000 rpm, 20 us";
  const char* sixteen = "4 cylinders, 16 valves, 6000 rpm, 20 us";
  const Row& library = r.row("tick", "library", eight);
  const Row& of_sixteen = r.row("tick", "library", sixteen);
  for (const char* plain : {"linear tables + textbook RK4", "libm + textbook RK4"}) {
    const std::string to = std::string("time of ") + plain + " to the library's";
    r.add("tick, 8 valves: " + to, r.row("tick", plain, eight).ns_median / library.ns_median, library);
    r.add("tick, 16 valves: " + to, r.row("tick", plain, sixteen).ns_median / of_sixteen.ns_median, of_sixteen);
  }
  const Row& pairs = r.row("tick", "library", "4 cylinders, 16 valves in pairs, 6000 rpm, 20 us");
  r.add("tick: time of 16 different valves to 8", of_sixteen.ns_median / library.ns_median, of_sixteen);
  r.add("tick: time of 16 valves in identical pairs to 8", pairs.ns_median / library.ns_median, pairs);
  const Row& held = r.row("growth", "one valve held by its train", "6000 rpm, 100 us");
  r.add("time of a tick of 100 us to one of 20 us, no contact change near",
        held.ns_median / r.row("growth", "one valve held by its train", "6000 rpm, 20 us").ns_median, held);
}

}  // namespace

std::vector<Row> ratio_rows(const std::vector<Row>& rows) {
  Ratios ratios(rows);
  add_kinematics(ratios);
  add_valve(ratios);
  add_ticks(ratios);
  return ratios.take();
}

}  // namespace crankloop::program::bench
