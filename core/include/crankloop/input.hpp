// What goes into a step: only what the scene asks for; giving more does not compile.
#pragma once

#include <cstdint>
#include <type_traits>

#include <crankloop/phase.hpp>
#include <crankloop/scene.hpp>

namespace crankloop {

template <class Real>
struct SpeedInput {
  Real speed_rad_s = 0;  ///< crank speed; negative = backwards
};
struct PhaseInput {
  Phase crank{};  ///< absolute: 0 = cylinder 1's firing top dead centre
};
inline constexpr double kMostLoad_Nm = 1e8;
template <class Real>
struct LoadTorqueInput {
  Real load_Nm = 0;  ///< on the crankshaft this tick, beside the definition's brake: positive against forward rotation; may drive; +-1e8
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
  Real pressure_Pa[S::cylinders.capacity] = {};  ///< absolute, at the end of this tick; 0 to kMostPressure_Pa
};

template <class Real, class S>
struct CamPhaseInput {
  Real cam_phase_deg[S::trains.capacity] = {};  ///< target, crank degrees later than defined; -180 to 180; moved at the train's limited rate
};

template <class Real, class S>
using CrankInput = std::conditional_t<S::crank == CrankGiven::speed, SpeedInput<Real>,
                                      std::conditional_t<S::crank == CrankGiven::phase, PhaseInput, LoadTorqueInput<Real>>>;

template <class Real, class S>
struct Input : CrankInput<Real, S>,
               If<Needs<S>::load, LoadInput<Real>>,
               If<Needs<S>::input_pressure, PressureInput<Real, S>>,
               If<S::cam_phasing, CamPhaseInput<Real, S>>,
               If<S::starter, StarterInput>,
               If<Needs<S>::cut, CylinderCutInput> {};

}  // namespace crankloop
