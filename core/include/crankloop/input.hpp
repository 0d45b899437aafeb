// What goes into a step: only what the scene asks for; giving more does not compile.
#pragma once

#include <cstdint>
#include <type_traits>

#include <crankloop/phase.hpp>
#include <crankloop/scene.hpp>

namespace crankloop {

inline constexpr double kMaxExternalTorque_Nm = 1e8;

inline constexpr double kLeastManifold_Pa = 1e3, kMaxManifold_Pa = 1e7;
inline constexpr double kLeastManifold_K = 150, kMaxManifold_K = 3000;
inline constexpr double kMaxFuel_kg = 0.01;     ///< of a cylinder's cycle
inline constexpr double kLeastFuel_kg = 1e-12;  ///< less is none
inline constexpr double kMaxExcessAir_ratio = 100;
/// No engine runs on more than four times the fuel that its air burns: the rest of such a cycle's fuel does not count.
inline constexpr double kLeastBurning_ratio = 0.25;

// The groups of inputs, each a base of Input where the scene asks for it.
namespace group {

template <class Real>
struct SpeedInput {
  Real speed_rad_s = 0;  ///< crank speed; negative = backwards
};
struct PhaseInput {
  Phase crank{};  ///< absolute: 0 = cylinder 1's firing top dead centre
};
template <class Real>
struct ExternalTorqueInput {
  Real external_torque_Nm = 0;  ///< on the crankshaft this tick, beside the definition's brake: positive against
                                ///< forward rotation; may drive; +-1e8
};
struct StarterInput {
  std::uint32_t starter = 0;  ///< 0 = off; else the starter turns the crank forward this tick
};
struct CylinderCutInput {
  std::uint32_t cut_cylinders = 0;  ///< bit k: cylinder k does not fire this tick, its pressure is the motored one
};
template <class Real>
struct LoadInput {
  Real load_ratio = 1;  ///< 0 = motored, 1 = the diagram as given; 0 to 2
};
template <class Real, class S>
struct PressureInput {
  Real pressure_Pa[S::cylinders.capacity] = {};  ///< absolute, at the end of this tick; 0 to kMaxPressure_Pa
};

/// The gas outside the ports, absolute; each 1e3 to 1e7 Pa, 150 to 3000 K.
template <class Real>
struct GivenManifoldInput {
  Real intake_Pa = static_cast<Real>(100e3);
  Real intake_K = static_cast<Real>(298.15);
  Real exhaust_Pa = static_cast<Real>(100e3);
  Real exhaust_K = static_cast<Real>(773.15);
};
template <class Real>
struct ThrottleInput {
  Real throttle_ratio = 1;  ///< 0 = closed, 1 = wide open
};
/// What is outside the manifolds, absolute; each 1e3 to 1e7 Pa, 150 to 3000 K, or 0: as defined, whatever the others
/// are.
template <class Real>
struct BoundaryInput {
  Real ambient_Pa = 0;  ///< before the throttle
  Real ambient_K = 0;   ///< before the throttle
  Real back_Pa = 0;     ///< behind the outlet
};
/// Of each cylinder, read where its cycle takes its fuel (Gas::latch_deg). A burn has to end by 150 deg.
template <class Real, class S>
struct CombustionInput {
  Real fuel_kg[S::cylinders.capacity] = {};  ///< per cycle; 0 to 0.01, less than 1e-12 is none
  /// Lambda. Above 0 the cycle gets as much fuel as the air in its cylinder asks for, instead of fuel_kg; 0 to 100.
  Real excess_air_ratio[S::cylinders.capacity] = {};
  Real burn_start_deg[S::cylinders.capacity] = {};     ///< after firing top dead centre, -90 to 60
  Real burn_duration_deg[S::cylinders.capacity] = {};  ///< of the first law; 5 to 150

  /// No fuel until some is given.
  constexpr CombustionInput() noexcept {
    for (std::uint32_t k = 0; k < S::cylinders.capacity; ++k) burn_start_deg[k] = -18, burn_duration_deg[k] = 50;
  }
};

template <class Real, class S>
struct CamPhaseInput {
  Real cam_phase_deg[S::trains.capacity] =
      {};  ///< target, crank degrees later than defined; -180 to 180; moved at the train's limited rate
};

struct WheelFaultInput {
  std::uint32_t wheel_faults = 0;  ///< bit b: faults of WheelFault::input_bit b are on this tick
};

struct SensorFaultInput {
  std::uint32_t sensor_faults = 0;  ///< bit b: faults of SensorFault::input_bit b are on this tick
};

/// The spark by a controller's name. The burn begins there, or after the delay of a burn by charge
/// (spark_to_start_deg).
template <class Real, class S>
struct SparkAdvanceInput {
  std::uint32_t by_spark_advance = 0;                  ///< 0: burn_start_deg counts; else spark_advance_deg instead
  Real spark_advance_deg[S::cylinders.capacity] = {};  ///< before firing top dead centre, -60 to 90
};

template <class Real, class S>
using CrankInput =
    std::conditional_t<S::crank == CrankGiven::speed, SpeedInput<Real>,
                       std::conditional_t<S::crank == CrankGiven::phase, PhaseInput, ExternalTorqueInput<Real>>>;

}  // namespace group

template <class Real, class S>
struct Input : group::CrankInput<Real, S>,
               detail::If<detail::Needs<S>::load, group::LoadInput<Real>>,
               detail::If<detail::Needs<S>::input_pressure, group::PressureInput<Real, S>>,
               detail::If<S::cam_phasing, group::CamPhaseInput<Real, S>>,
               detail::If<S::starter, group::StarterInput>,
               detail::If<detail::Needs<S>::cut || detail::Needs<S>::gas_cut, group::CylinderCutInput>,
               detail::If<detail::Needs<S>::gas && !detail::Needs<S>::manifolds, group::GivenManifoldInput<Real>>,
               detail::If<detail::Needs<S>::manifolds, group::ThrottleInput<Real>>,
               detail::If<S::boundaries, group::BoundaryInput<Real>>,
               detail::If<detail::Needs<S>::burn_input, group::CombustionInput<Real, S>>,
               detail::If<detail::Needs<S>::faulty_wheels, group::WheelFaultInput>,
               detail::If<S::sensor_faults, group::SensorFaultInput>,
               detail::If<S::controller_names, group::SparkAdvanceInput<Real, S>> {};

}  // namespace crankloop
