// The group "ratios": what was asked of the library, and what the rows of this run say of it.
//
// What belongs here: which rows make a goal. What does not: measuring.
#include "groups.hpp"

#include <cmath>

namespace crankloop::program::bench {
namespace {

/// numerics of the prototypes that the plain engines are checked against: libm and linear tables, 16 valves, ns per
/// tick.
constexpr double kPrototypeLibm_ns = 422;
constexpr double kPrototypeLinear_ns = 226;
constexpr double kPrototypeMargin = 0.15;

/// "No dearer", between two medians of this machine.
constexpr double kScatter = 0.03;

class Ratios {
 public:
  explicit Ratios(const std::vector<Row>& rows) : rows_{rows} {}

  [[nodiscard]] const Row& row(const char* group, const char* contestant, const char* setting,
                               const char* real = "float") const {
    return find(rows_, group, contestant, real, setting);
  }
  void at_least(const std::string& what, double asked, double reached, const Row& of) {
    add(what, {asked, reached, true}, of);
  }
  void at_most(const std::string& what, double asked, double reached, const Row& of) {
    add(what, {asked, reached, false}, of);
  }
  [[nodiscard]] std::vector<Row> take() { return std::move(out_); }

 private:
  /// A goal stands beside the time and the error of the row that it judges.
  void add(const std::string& what, Goal goal, const Row& of) {
    Row row = of;
    row.group = "ratios";
    row.contestant = what;
    row.goal = goal;
    out_.push_back(std::move(row));
  }

  const std::vector<Row>& rows_;
  std::vector<Row> out_;
};

void add_kinematics(Ratios& r) {
  const Row& library = r.row("kinematics", "library", "1 deg");
  const Row& linear = r.row("kinematics", "linear", "1 deg");
  r.at_least("kinematics: time of libm double to the library's", 10,
             r.row("kinematics", "libm sin/cos/sqrt", "exact", "double").ns_median / library.ns_median, library);
  r.at_most("kinematics: the library's time to that of linear tables", 1.3, library.ns_median / linear.ns_median,
            library);
  r.at_least("kinematics: error of linear tables to the library's", 100, linear.error / library.error, library);
}

void add_valve(Ratios& r) {
  const Row& textbook = r.row("valve", "textbook RK4", "12000 rpm, 10 us");
  const Row& rk4 = r.row("valve", "located RK4", "12000 rpm, 10 us");
  const Row& exponential = r.row("valve", "located exponential", "12000 rpm, 10 us");
  r.at_most("bouncing valve: error of located exponential, um", 0.2, exponential.error, exponential);
  r.at_most("bouncing valve: error of located RK4, um", 1, rk4.error, rk4);
  r.at_least("bouncing valve: error of the textbook's, um", 10, textbook.error, textbook);
  r.at_most("bouncing valve: time of located exponential to the textbook's", 0.6,
            exponential.ns_median / textbook.ns_median, exponential);
  r.at_most("bouncing valve: time of located RK4 to the textbook's", 0.6, rk4.ns_median / textbook.ns_median, rk4);
}

void add_ticks(Ratios& r) {
  const char* eight = "4 cylinders, 8 valves, 6000 rpm, 20 us";
  const char* sixteen = "4 cylinders, 16 valves, 6000 rpm, 20 us";
  const char* linear = "linear tables + textbook RK4";
  const char* libm = "libm + textbook RK4";
  const Row& library = r.row("tick", "library", eight);
  const Row& of_sixteen = r.row("tick", "library", sixteen);
  const Row& pairs = r.row("tick", "library", "4 cylinders, 16 valves in pairs, 6000 rpm, 20 us");
  r.at_least("tick, 8 valves: time of linear tables + textbook RK4 to the library's", 3.5,
             r.row("tick", linear, eight).ns_median / library.ns_median, library);
  r.at_least("tick, 8 valves: time of libm + textbook RK4 to the library's", 8,
             r.row("tick", libm, eight).ns_median / library.ns_median, library);
  r.at_most("tick: 16 different valves to 8", 1.5, of_sixteen.ns_median / library.ns_median, of_sixteen);
  r.at_most("tick: 16 valves in identical pairs to 8", 1 + kScatter, pairs.ns_median / library.ns_median, pairs);
  const Row& held = r.row("growth", "one valve held by its train", "6000 rpm, 100 us");
  r.at_most("a tick of 100 us to one of 20 us, no contact change near", 1.6,
            held.ns_median / r.row("growth", "one valve held by its train", "6000 rpm, 20 us").ns_median, held);
  const Row& torque = r.row("skips", "torque", "4 cylinders, 0 valves, 6000 rpm, 20 us");
  r.at_most("torque of given pressures, 4 cylinders, ns", 8, torque.ns_median, torque);

  const double plain = r.row("tick", libm, sixteen).ns_median / r.row("tick", linear, sixteen).ns_median;
  r.at_most("check of the plain engines: their ratio off that of the prototypes", kPrototypeMargin,
            std::fabs(plain / (kPrototypeLibm_ns / kPrototypeLinear_ns) - 1), r.row("tick", linear, sixteen));
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
