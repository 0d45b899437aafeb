// The group "kinematics": x, v, a of one piston at random phases.
#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "engines.hpp"
#include "groups.hpp"
#include "motion_methods.hpp"

namespace crankloop::program::bench {
namespace {

constexpr std::size_t kPhases = 4096;  // their table and the largest method's fit into the second-level cache
constexpr std::size_t kErrorPhases = 200000;

/// splitmix64: phases without a pattern, the same in every run.
class Phases {
 public:
  [[nodiscard]] std::uint64_t next() noexcept {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15u);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }

 private:
  std::uint64_t state_ = 495;
};

class Group {
 public:
  Group() : crank_{diesel_495_crank()} {
    Phases random;
    for (std::uint64_t& phase : *phases_) phase = random.next();
    const ExactMotion<long double> exact(crank_);
    for (Known& known : known_) {
      known.phase = random.next();
      known.motion = true_motion(exact, known.phase);
    }
  }

  template <class Real, class Method>
  void add(const char* contestant, const char* setting) {
    const auto method = std::make_shared<const Method>(crank_);
    Row row;
    row.group = "kinematics";
    row.contestant = contestant;
    row.real = sizeof(Real) == 4 ? "float" : "double";
    row.setting = setting;
    row.per = "evaluation";
    row.error = largest_error(*method);
    row.error_unit = "of r, r w, r w^2";
    rows_.push_back(row);
    contestants_.push_back({[method, phases = phases_] {
                              const Real w = static_cast<Real>(209.44);
                              for (const std::uint64_t phase : *phases) {
                                const Motion<Real> m = method->at(phase);
                                keep(Motion<Real>{m.x, m.v * w, m.a * (w * w)});
                              }
                            },
                            static_cast<double>(kPhases)});
  }

  [[nodiscard]] std::vector<Row> run(const Effort& effort) {
    const std::vector<Timing> timings = race(contestants_, effort);
    for (std::size_t i = 0; i < rows_.size(); ++i)
      rows_[i].ns_median = timings[i].median_ns, rows_[i].ns_spread = timings[i].spread_ns;
    return std::move(rows_);
  }

 private:
  /// Of the three quantities, each relative to its scale.
  template <class Method>
  [[nodiscard]] double largest_error(const Method& method) const {
    long double largest = 0;
    for (const Known& known : known_) {
      const auto m = method.at(known.phase);
      largest = std::max({largest, std::fabs(static_cast<long double>(m.x) - known.motion.x),
                          std::fabs(static_cast<long double>(m.v) - known.motion.v),
                          std::fabs(static_cast<long double>(m.a) - known.motion.a)});
    }
    return static_cast<double>(largest / static_cast<long double>(crank_.crank_radius_m));
  }

  struct Known {
    std::uint64_t phase;
    Motion<long double> motion;
  };
  using PhaseList = std::vector<std::uint64_t>;
  Crank crank_;
  std::vector<Known> known_ = std::vector<Known>(kErrorPhases);
  std::shared_ptr<PhaseList> phases_ = std::make_shared<PhaseList>(kPhases);
  std::vector<Row> rows_;
  std::vector<Contestant> contestants_;
};

template <class Real>
void add_tables(Group& group) {
  group.add<Real, NearestTable<Real, 360>>("nearest", "1 deg");
  group.add<Real, NearestTable<Real, 3600>>("nearest", "0.1 deg");
  group.add<Real, LinearTable<Real, 180>>("linear", "2 deg");
  group.add<Real, LinearTable<Real, 360>>("linear", "1 deg");
  group.add<Real, LinearTable<Real, 720>>("linear", "0.5 deg");
  group.add<Real, LinearTable<Real, 3600>>("linear", "0.1 deg");
  group.add<Real, LibraryMotion<Real>>("library", "1 deg");
  group.add<Real, PolynomialTable<Real, 90, 2>>("quadratic", "4 deg");
  group.add<Real, PolynomialTable<Real, 180, 2>>("quadratic", "2 deg");
  group.add<Real, PolynomialTable<Real, 360, 2>>("quadratic", "1 deg");
  group.add<Real, PolynomialTable<Real, 720, 2>>("quadratic", "0.5 deg");
  group.add<Real, PolynomialTable<Real, 90, 3>>("cubic", "4 deg");
  group.add<Real, PolynomialTable<Real, 360, 3>>("cubic", "1 deg");
  group.add<Real, PolynomialTable<Real, 24, 4>>("quartic", "15 deg");
  group.add<Real, PolynomialTable<Real, 90, 5>>("quintic", "4 deg");
}

}  // namespace

std::vector<Row> kinematics_rows(const Effort& effort) {
  Group group;
  if (!LibraryMotion<float>(diesel_495_crank()).status().ok()) throw std::logic_error("the 495's crank was refused");
  group.add<double, TextbookMotion<double>>("libm asin", "exact");
  group.add<double, ExactMotion<double>>("libm sin/cos/sqrt", "exact");
  group.add<float, ExactMotion<float>>("libm sin/cos/sqrt", "exact");
  add_tables<float>(group);
  add_tables<double>(group);
  return group.run(effort);
}

}  // namespace crankloop::program::bench
