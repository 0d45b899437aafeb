// From a definition and a tick length to the tables that the tick reads.
//
// What belongs here: the call and the memory it fills. What does not: the sections' meaning (tick/tables.hpp).
#pragma once

#include <cstddef>

#include <crankloop/define/engine_definition.hpp>
#include <crankloop/status.hpp>
#include <crankloop/tabulate/valve_motion.hpp>
#include <crankloop/tick/tables.hpp>

namespace crankloop {

/// How the engine will be stepped.
struct TickOptions {
  double tick_s = 100e-6;    ///< 1e-6 to 2e-3
  ValveStepping valves{};    ///< integrator and accuracy of elastic valves
};

/// Most segments of a grid: 20 in every degree.
inline constexpr std::size_t kMostGasSegments = 20 * kDegreesPerCycle;

/// Where to build each section; null = leave it out. Pressures go with a gas_grid, gas torques with a torque_grid, cut_torque with a cut_grid; each has room for
/// `gas_capacity` segments. A gas torque goes with its segments, lift curves with theirs and their rocker ratios, triggers with tracks and edges.
template <class Real>
struct TableTargets {
  Drive<Real>* drive = nullptr;
  Body<Real>* body = nullptr;
  IntegratedCurve<Real>* stroke = nullptr;
  Revolution<MotionSegment<Real>>* motion = nullptr;
  Revolution<LeanSegment<Real>>* lean = nullptr;
  Revolution<RodSegment<Real>>* rod = nullptr;
  Curve<Real>* rod_curvature = nullptr;
  IntegratedCurve<Real>* inertia_torque = nullptr;
  Bearings<Real>* bearings = nullptr;
  Balance<Real>* balance = nullptr;
  GasGrid* gas_grid = nullptr;
  GasGrid* torque_grid = nullptr;
  int gas_capacity = 0;  ///< at least 720 where there is a grid
  Segment<Real>* pressure_full = nullptr;
  Segment<Real>* pressure_motored = nullptr;
  Segment<Real>* pressure_heat = nullptr;
  GasTorque<Real>* gas_torque_full = nullptr;
  GasTorque<Real>* gas_torque_motored = nullptr;
  GasTorque<Real>* gas_torque_heat = nullptr;
  GasGrid* cut_grid = nullptr;
  GasTorque<Real>* cut_torque = nullptr;
  CrankDynamics<Real>* crank_dynamics = nullptr;
  LiftCurve<Real>* lift_curves = nullptr;          ///< one per train of the definition
  LiftSegment<Real>* lift_segments = nullptr;      ///< kDegreesPerTurn per train
  Segment<Real>* rocker_ratios = nullptr;          ///< likewise
  ValveMotion<Real>* valve_motions = nullptr;      ///< one per train
  IntegratedSegment<Real>* gas_full = nullptr;  ///< segments of gas_torque_full, and so on
  IntegratedSegment<Real>* gas_motored = nullptr;
  IntegratedSegment<Real>* gas_heat = nullptr;
  IntegratedSegment<Real>* cut_heat = nullptr;
  TriggerWheels* triggers = nullptr;
  TriggerTrack* trigger_tracks = nullptr;    ///< one per wheel of the definition
  std::uint32_t* trigger_edges = nullptr;    ///< kMaxTriggerEdges per wheel
};

/// What tabulate found.
struct TableReport {
  int gas_segments = 0;           ///< segments of the pressures' grid
  int tolerance_doublings = 0;    ///< how often the pressure's tolerance was doubled to fit the capacity
  double pressure_error_Pa = 0;   ///< largest error of full, motored and heat pressure against the diagram, at 10 places of an undivided degree, 60 of another
  int torque_segments = 0;        ///< segments of the gas torques' grid
  int torque_doublings = 0;
  double torque_error_Nm = 0;     ///< largest error of full, motored and heat torque of all cylinders, likewise at 10, and 40 (float: 60)
  int cut_segments = 0;           ///< segments of the grid of one cylinder's heat torque
  int cut_doublings = 0;
  int valve_fine_steps = 0;       ///< of all elastic valves in the worst tick, when contacts may change in all of them; at most kMostFineStepsOfEngine
  int valve_changes = 0;          ///< contact changes that a tick locates
};

/// Fills the targets. Validates the definition first; nothing is written when it refuses.
///
/// Accuracy: docs/model.md "Tables". A grid divides a degree into 1, 2, 5, 10 or 20 segments, the fewest that keep the pressure
/// within 1e-5 of its peak (the torque: of the peak pressure on the crank radius), or 20; where the capacity does not suffice the bound is doubled until it does. The report tells what is left.
/// Float and double; O(segments), some 100 ms on a desktop.
template <class Real>
Status tabulate(const EngineDefinition& engine, const TickOptions& options, const TableTargets<Real>& targets,
                TableReport* report = nullptr) noexcept;

namespace part {
// One holder per group of sections: a base of TableStorage when the scene needs it.
template <class Real> struct BodyStore { Body<Real> body; };
template <class Real> struct StrokeStore { IntegratedCurve<Real> stroke; };
template <class Real> struct MotionStore { Revolution<MotionSegment<Real>> motion; };
template <class Real> struct LeanStore { Revolution<LeanSegment<Real>> lean; };
template <class Real> struct RodStore { Revolution<RodSegment<Real>> rod; };
template <class Real> struct RodCurvatureStore { Curve<Real> rod_curvature; };
template <class Real> struct InertiaTorqueStore { IntegratedCurve<Real> inertia_torque; };
template <class Real> struct BearingsStore { Bearings<Real> bearings; };
template <class Real> struct BalanceStore { Balance<Real> balance; };
struct GasGridStore { GasGrid gas_grid; };
struct TorqueGridStore { GasGrid torque_grid; };
template <class Real, std::size_t N> struct PressureStore { Segment<Real> pressure_full[N]; };
template <class Real, std::size_t N> struct PressureByLoadStore { Segment<Real> pressure_motored[N]; Segment<Real> pressure_heat[N]; };
template <class Real, std::size_t N> struct GasTorqueStore { GasTorque<Real> gas_torque_full; IntegratedSegment<Real> gas_full[N]; };
template <class Real, std::size_t N> struct GasTorqueByLoadStore {
  GasTorque<Real> gas_torque_motored;
  GasTorque<Real> gas_torque_heat;
  IntegratedSegment<Real> gas_motored[N];
  IntegratedSegment<Real> gas_heat[N];
};
template <class Real, std::size_t N> struct CutTorqueStore { GasGrid cut_grid; GasTorque<Real> cut_torque; IntegratedSegment<Real> cut_heat[N]; };
template <class Real> struct CrankDynamicsStore { CrankDynamics<Real> crank_dynamics; };
template <class Real, std::size_t Trains> struct LiftStore {
  LiftCurve<Real> lift_curves[Trains];
  LiftSegment<Real> lift_segments[Trains * kDegreesPerTurn];
  Segment<Real> rocker_ratios[Trains * kDegreesPerTurn];
};
template <class Real, std::size_t Trains> struct ValveMotionStore { ValveMotion<Real> valve_motions[Trains]; };
template <std::size_t Wheels> struct TriggerStore {
  TriggerWheels triggers;
  TriggerTrack trigger_tracks[Wheels];
  std::uint32_t trigger_edges[Wheels * kMaxTriggerEdges];
};
}  // namespace part

/// Tables in RAM: the sections that a scene needs, and no others. Large (tens of kB to 1 MB): static or on the heap, not on a stack.
///
///     static crankloop::TableStorage<float, MyScene> storage;
///     if (!storage.build(definition, {100e-6}).ok()) ...
///     engine.init(storage.tables());
///
/// Not copyable: engines point into it.
template <class Real, class S, std::size_t GasSegments = 4096>
class TableStorage : If<Needs<S>::body, part::BodyStore<Real>>,
                     If<Needs<S>::stroke, part::StrokeStore<Real>>,
                     If<Needs<S>::motion, part::MotionStore<Real>>,
                     If<Needs<S>::lean, part::LeanStore<Real>>,
                     If<Needs<S>::rod, part::RodStore<Real>>,
                     If<Needs<S>::rod_curvature, part::RodCurvatureStore<Real>>,
                     If<Needs<S>::inertia_torque, part::InertiaTorqueStore<Real>>,
                     If<S::bearing_loads, part::BearingsStore<Real>>,
                     If<S::free_forces, part::BalanceStore<Real>>,
                     If<Needs<S>::gas_pressure, part::GasGridStore>,
                     If<Needs<S>::gas_torque, part::TorqueGridStore>,
                     If<Needs<S>::gas_pressure && !Needs<S>::load, part::PressureStore<Real, GasSegments>>,
                     If<Needs<S>::gas_pressure && Needs<S>::load, part::PressureByLoadStore<Real, GasSegments>>,
                     If<Needs<S>::gas_torque && !Needs<S>::load, part::GasTorqueStore<Real, GasSegments>>,
                     If<Needs<S>::gas_torque && Needs<S>::load, part::GasTorqueByLoadStore<Real, GasSegments>>,
                     If<Needs<S>::cut_torque, part::CutTorqueStore<Real, GasSegments>>,
                     If<Needs<S>::crank_dynamics, part::CrankDynamicsStore<Real>>,
                     If<Needs<S>::any_valves, part::LiftStore<Real, S::trains.capacity>>,
                     If<Needs<S>::elastic_valves, part::ValveMotionStore<Real, S::trains.capacity>>,
                     If<Needs<S>::any_triggers, part::TriggerStore<S::triggers.capacity>> {
  static_assert(GasSegments >= std::size_t{kDegreesPerCycle} && GasSegments <= kMostGasSegments, "720 to 14400 gas segments");

 public:
  TableStorage() = default;
  TableStorage(const TableStorage&) = delete;
  TableStorage& operator=(const TableStorage&) = delete;

  /// Tabulates; after a refusal the old tables are gone and tables() is refused by init. No engine may run on them meanwhile, and every
  /// engine that did must be initialised anew.
  Status build(const EngineDefinition& engine, const TickOptions& options, TableReport* report = nullptr) noexcept {
    using N = Needs<S>;
    tables_ = {};
    TableTargets<Real> t;
    t.drive = &drive_;
    if constexpr (N::body) t.body = &this->body;
    if constexpr (N::stroke) t.stroke = &this->stroke;
    if constexpr (N::motion) t.motion = &this->motion;
    if constexpr (N::lean) t.lean = &this->lean;
    if constexpr (N::rod) t.rod = &this->rod;
    if constexpr (N::rod_curvature) t.rod_curvature = &this->rod_curvature;
    if constexpr (N::inertia_torque) t.inertia_torque = &this->inertia_torque;
    if constexpr (S::bearing_loads) t.bearings = &this->bearings;
    if constexpr (S::free_forces) t.balance = &this->balance;
    if constexpr (N::gas_pressure) t.gas_grid = &this->gas_grid;
    if constexpr (N::gas_torque) t.torque_grid = &this->torque_grid;
    t.gas_capacity = static_cast<int>(GasSegments);
    if constexpr (N::gas_pressure && !N::load) t.pressure_full = this->pressure_full;
    if constexpr (N::gas_pressure && N::load) t.pressure_motored = this->pressure_motored, t.pressure_heat = this->pressure_heat;
    if constexpr (N::gas_torque && !N::load) t.gas_torque_full = &this->gas_torque_full, t.gas_full = this->gas_full;
    if constexpr (N::gas_torque && N::load) {
      t.gas_torque_motored = &this->gas_torque_motored;
      t.gas_torque_heat = &this->gas_torque_heat;
      t.gas_motored = this->gas_motored;
      t.gas_heat = this->gas_heat;
    }
    if constexpr (N::cut_torque) t.cut_grid = &this->cut_grid, t.cut_torque = &this->cut_torque, t.cut_heat = this->cut_heat;
    if constexpr (N::crank_dynamics) t.crank_dynamics = &this->crank_dynamics;
    if constexpr (N::any_valves) {
      if (engine.train_count > static_cast<int>(S::trains.capacity)) return {Reason::out_of_range, -1, "scene.trains"};
      t.lift_curves = this->lift_curves;
      t.lift_segments = this->lift_segments;
      t.rocker_ratios = this->rocker_ratios;
    }
    if constexpr (N::elastic_valves) t.valve_motions = this->valve_motions;
    if constexpr (N::any_triggers) {
      if (engine.trigger_count > static_cast<int>(S::triggers.capacity)) return {Reason::out_of_range, -1, "scene.triggers"};
      t.triggers = &this->triggers;
      t.trigger_tracks = this->trigger_tracks;
      t.trigger_edges = this->trigger_edges;
    }
    if (const Status refused = tabulate(engine, options, t, report); !refused.ok()) return refused;
    tables_ = Tables<Real, S>(sections_of(t));
    return {};
  }

  [[nodiscard]] const Tables<Real, S>& tables() const noexcept { return tables_; }

 private:
  [[nodiscard]] static Sections<Real> sections_of(const TableTargets<Real>& t) noexcept {
    Sections<Real> s;
    s.drive = t.drive;
    s.body = t.body;
    s.stroke = t.stroke;
    s.motion = t.motion;
    s.lean = t.lean;
    s.rod = t.rod;
    s.rod_curvature = t.rod_curvature;
    s.inertia_torque = t.inertia_torque;
    s.bearings = t.bearings;
    s.balance = t.balance;
    s.gas_grid = t.gas_grid;
    s.torque_grid = t.torque_grid;
    s.pressure_full = t.pressure_full;
    s.pressure_motored = t.pressure_motored;
    s.pressure_heat = t.pressure_heat;
    s.gas_torque_full = t.gas_torque_full;
    s.gas_torque_motored = t.gas_torque_motored;
    s.gas_torque_heat = t.gas_torque_heat;
    s.cut_grid = t.cut_grid;
    s.cut_torque = t.cut_torque;
    s.crank_dynamics = t.crank_dynamics;
    s.lift_curves = t.lift_curves;
    s.valve_motions = t.valve_motions;
    s.triggers = t.triggers;
    return s;
  }

  Drive<Real> drive_{};
  Tables<Real, S> tables_{};
};

}  // namespace crankloop
