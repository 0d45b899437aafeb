// A whole engine's tick as plain code, the reference of the ratios.
//
// What belongs here: inputs and outputs of such an engine. What does not: its code (baseline.inl), timing (tick.cpp).
// It includes no header of crankloop: see plain_valve.hpp.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "plain_valve.hpp"

namespace crankloop::program::bench {

/// Method of the pistons' motion.
enum class PlainPistons { libm, linear_tables };

/// All that the plain engine needs; angles in degrees of the crank.
struct PlainEngineData {
  double crank_radius_m, rod_length_m, bore_area_m2, crankcase_Pa, reciprocating_kg;
  double tick_s;
  double speed_rad_s;
  double start_deg;                            ///< engine angle before the first tick
  std::vector<double> firing_deg;              ///< per cylinder
  std::vector<double> lobe_opens_deg;          ///< per train, in the cylinder's own cycle
  std::vector<double> lift_m, lift_per_deg_m;  ///< at 361 cam degrees since the lobe's opening, the same for all trains
  PlainBody<double> valve;
};

/// Per cylinder.
template <class Real>
struct PlainPiston {
  Real displacement_m, velocity_m_s, acceleration_m_s2;
};
/// Per cylinder and train.
template <class Real>
struct PlainValve {
  Real lift_m, velocity_m_s;
};

template <class Real>
class PlainEngine {
 public:
  virtual ~PlainEngine() = default;
  /// Pressures per cylinder, absolute.
  virtual void step(const Real* pressure_Pa) noexcept = 0;

  std::vector<PlainPiston<Real>> pistons;  ///< outputs of the last tick
  std::vector<PlainValve<Real>> valves;    ///< [cylinder * trains + train]
  Real torque_Nm = 0;
  std::uint64_t phase = 0;  ///< after it; 2^64 are 720 deg
};

/// Compiled with the flags of the rest.
template <class Real>
[[nodiscard]] std::unique_ptr<PlainEngine<Real>> plain_engine(PlainPistons pistons, const PlainEngineData& data);
/// Compiled without the flags that keep the library's bits, to show what plain code gains by that.
template <class Real>
[[nodiscard]] std::unique_ptr<PlainEngine<Real>> plain_engine_of_usual_flags(PlainPistons pistons,
                                                                             const PlainEngineData& data);

}  // namespace crankloop::program::bench
