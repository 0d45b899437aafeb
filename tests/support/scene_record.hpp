// An engine's life in a test, and all that a scene says in it, as bytes: so that scenes are compared by what is no
// template. Every scene is an engine to compile, some 0.3 s each.
//
// What belongs here: what goes in, what comes out, how two records are compared. What does not: which scenes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/engines.hpp"
#include "support/output_numbers.hpp"
#include "support/running.hpp"

namespace crankloop::tick_test {

constexpr double kLifeTick_s = 200e-6;
constexpr int kLifeTicks = 330;
constexpr int kLifeGasSegments = 1500;

// ---- what goes in ---------------------------------------------------------------------------------------------------

/// An engine's life in a test: it speeds up and slows down, crawls, stands, turns back; load and pressures vary; some
/// inputs are bad.
struct Moment {
  double speed_rad_s;
  double load_ratio;
  std::array<double, kMaxCylinders> pressure_Pa;
};
inline std::vector<Moment> make_life() {
  std::vector<Moment> moments;
  for (int tick = 0; tick < kLifeTicks; ++tick) {
    Moment m{};
    const double crawl[] = {0, 0.001, -0.002, 0.5, 4, -7};
    const double speed = tick % 60 < 54 ? 150 + 1.1 * (tick % 97) : crawl[tick % 6];
    m.speed_rad_s = tick > 280 ? -speed : speed;
    if (tick % 71 == 70) m.speed_rad_s = 1e30;
    m.load_ratio = tick % 83 == 82 ? -5 : 0.02 * (tick % 53);
    for (int k = 0; k < kMaxCylinders; ++k)
      m.pressure_Pa[static_cast<std::size_t>(k)] = 1e5 + 3e4 * ((tick + 31 * k) % 89);
    if (tick % 91 == 90) m.pressure_Pa[0] = -1;
    moments.push_back(m);
  }
  return moments;
}
inline const std::vector<Moment>& life() {
  static const std::vector<Moment> moments = make_life();
  return moments;
}

template <class Real, class S>
Input<Real, S> input_at(const Moment& m) {
  Input<Real, S> in;
  in.speed_rad_s = static_cast<Real>(m.speed_rad_s);
  if constexpr (detail::Needs<S>::load) in.load_ratio = static_cast<Real>(m.load_ratio);
  if constexpr (detail::Needs<S>::input_pressure) {
    for (std::uint32_t k = 0; k < S::cylinders.capacity; ++k) in.pressure_Pa[k] = static_cast<Real>(m.pressure_Pa[k]);
  }
  return in;
}

// ---- what comes out -------------------------------------------------------------------------------------------------

/// All that a scene said in its life: the bytes of each group it has, tick after tick, in the order of Group's bits.
struct Record {
  unsigned groups = 0;
  std::array<std::string, 7> bytes;
  std::vector<std::uint32_t> faults;
  std::uint32_t possible_faults = 0;
};

/// The scene's groups, as far as they are in use, appended to the record.
class Recorder {
 public:
  explicit Recorder(Record& record) : record_{record} {}
  void row(unsigned group, const void* first, std::size_t bytes);

 private:
  Record& record_;
};
inline void Recorder::row(unsigned group, const void* first, std::size_t bytes) {
  std::size_t index = 0;
  while ((1u << index) != group) ++index;
  record_.groups |= group;
  record_.bytes[index].append(static_cast<const char*>(first), bytes);
}

template <class Real, class S>
void record_output(const Output<Real, S>& out, const InUse& use, Recorder to) {
  const std::size_t cylinders = use.cylinders * sizeof(Real);
  const std::size_t pins = use.pins * sizeof(Real);
  const std::size_t journals = (use.pins + 1) * sizeof(Real);
  if constexpr (S::kinematics) {
    for (const Real* row : {out.displacement_m, out.velocity_m_s, out.acceleration_m_s2})
      to.row(kKinematics, row, cylinders);
  }
  if constexpr (S::rod_motion) {
    for (const Real* row : {out.rod_angle_rad, out.rod_speed_rad_s, out.rod_acceleration_rad_s2})
      to.row(kRodMotion, row, cylinders);
  }
  if constexpr (S::torque) to.row(kTorque, &out.torque_Nm, sizeof(Real));
  if constexpr (S::mean_torque) to.row(kMeanTorque, &out.mean_torque_Nm, sizeof(Real));
  if constexpr (S::forces) {
    static_assert(sizeof(CylinderForces<Real>) == 10 * sizeof(Real), "numbers and no padding");
    to.row(kForces, out.cylinder, use.cylinders * sizeof(CylinderForces<Real>));
  }
  if constexpr (S::bearing_loads) {
    for (const Real* row : {out.pin_radial_N, out.pin_tangential_N, out.pin_load_N}) to.row(kBearingLoads, row, pins);
    for (const Real* row : {out.journal_along_N, out.journal_across_N, out.journal_load_N})
      to.row(kBearingLoads, row, journals);
  }
  if constexpr (S::free_forces) {
    static_assert(sizeof(group::FreeForces<Real>) == 12 * sizeof(Real), "numbers and no padding");
    to.row(kFreeForces, static_cast<const group::FreeForces<Real>*>(&out), sizeof(group::FreeForces<Real>));
  }
}

/// A bad load ratio is no fault of a scene in which nothing depends on it, nor is a bad pressure.
template <class S>
inline constexpr std::uint32_t kFaultsOf = std::uint32_t{kFaultSpeed} |
                                           (detail::Needs<S>::load ? kFaultLoadRatio : 0u) |
                                           (detail::Needs<S>::input_pressure ? kFaultPressure : 0u);

template <class Real, class S>
Record record_of(const FullTables<Real>& tables) {
  Running<Real, S> run(tables, phase_at_deg(33));
  const InUse use = in_use(tables);
  Record record;
  record.possible_faults = kFaultsOf<S>;
  for (const Moment& m : life()) {
    const Output<Real, S>& out = run.engine.step(input_at<Real, S>(m));
    record_output<Real, S>(out, use, Recorder{record});
    record.faults.push_back(out.faults);
  }
  return record;
}

/// Bit for bit the same in every group of `groups`, and in the faults that `got` can have.
inline void expect_same(const Record& got, const Record& want, unsigned groups) {
  ASSERT_EQ(groups & ~got.groups, 0u) << "groups " << got.groups << ": not said";
  ASSERT_EQ(groups & ~want.groups, 0u) << "groups " << got.groups << ": nothing to compare with";
  for (std::size_t g = 0; g < got.bytes.size(); ++g) {
    if ((groups >> g & 1) == 0) continue;
    const std::string &a = got.bytes[g], &b = want.bytes[g];
    ASSERT_EQ(a.size(), b.size()) << "group " << (1u << g);
    ASSERT_GE(a.size(), static_cast<std::size_t>(kLifeTicks) * sizeof(float)) << "group " << (1u << g);
    std::size_t at = 0;
    while (at < a.size() && a[at] == b[at]) ++at;
    ASSERT_EQ(at, a.size()) << "groups " << got.groups << ": group " << (1u << g) << " differs at tick "
                            << at / (a.size() / kLifeTicks);
  }
  for (std::size_t tick = 0; tick < got.faults.size(); ++tick)
    ASSERT_EQ(got.faults[tick], want.faults[tick] & got.possible_faults)
        << "groups " << got.groups << ", tick " << tick;
}

}  // namespace crankloop::tick_test
