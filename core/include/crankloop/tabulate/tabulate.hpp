// From a definition and a tick length to the tables that the tick reads.
//
// What belongs here: the call and the memory it fills. What does not: the sections' meaning (tables/tables.hpp).
#pragma once

#include <cstddef>
#include <type_traits>

#include <crankloop/define/engine_definition.hpp>
#include <crankloop/status.hpp>
#include <crankloop/tables/tables.hpp>
#include <crankloop/tabulate/valve_motion.hpp>

namespace crankloop {

/// Options of the tick.
struct TickOptions {
  double tick_s = 100e-6;      ///< 1e-6 to 2e-3
  ValveStepping valves{};      ///< integrator and accuracy of elastic valves
  double max_speed_rad_s = 0;  ///< a tick refuses a higher speed as input; 0 = maximum of the definition. At most
                               ///< kMaxSpeed_rad_s; independently of it, a tick turns the crank by at most one
                               ///< revolution
};

/// Maximum number of segments of a grid: 20 in every degree.
inline constexpr std::size_t kMaxGasSegments = std::size_t{20} * kDegreesPerCycle;

/// Where to build each section; null = leave it out. Pressures need a gas_grid, gas torques a torque_grid, cut_torque a
/// cut_grid; each has room for `gas_capacity` segments. A gas torque needs its segments, lift curves their segments and
/// rocker ratios (kDegreesPerTurn rows per train of the definition), near_cams, near_lobes and cycle_ends need lift
/// curves; cam_contacts and cam_torques need those and cam_sliding, cam_contacts their segments too; triggers need
/// tracks and edges (kMaxTriggerEdges rows per wheel), wheel_faults their rules, and tracks and edges of each.
template <class Real>
struct TableTargets : detail::part::Targets<Real, detail::part::AllSections> {
  int gas_capacity = 0;  ///< at least 720 where there is a grid
};

/// Sizes and errors of the tables.
struct TableReport {
  int gas_segments = 0;          ///< segments of the pressures' grid
  int tolerance_doublings = 0;   ///< how often the pressure's tolerance was doubled to fit the capacity
  double pressure_error_Pa = 0;  ///< largest error of full, motored and heat pressure against the diagram, at 10 angles
                                 ///< of an undivided degree, 60 of a divided one
  int torque_segments = 0;       ///< segments of the gas torques' grid
  int torque_doublings = 0;
  double torque_error_Nm = 0;  ///< largest error of full, motored and heat torque of all cylinders, at 10 angles of an
                               ///< undivided degree, 40 of a divided one (float: 60)
  int cut_segments = 0;        ///< segments of the grid of one cylinder's heat torque
  int cut_doublings = 0;
  int valve_fine_steps = 0;    ///< of all elastic valves in the worst tick, in which a guard of every valve fails; at
                               ///< most kMaxFineStepsOfEngine
  int event_budget = 0;        ///< units of work that a tick may spend on events, over all elastic valves
  double valve_class_deg = 0;  ///< cam degrees of a tick up to which all elastic valves keep their accuracy class, 360
                               ///< if always; in longer ticks a cubic does not represent the cam's lift over a fine
                               ///< step
  double static_redline_rad_s = 0;  ///< lowest of all elastic valves' trains, speed of the crank
                                    ///< (tabulate/spring_margin.hpp); 0: no train, no elastic valve, or none opens
  double static_redline_deg = 0;    ///< where on that train's lobe: cam degrees from full lift
  int static_redline_train = -1;    ///< which train; -1: none
  double surge_error_ratio = 0;     ///< of the surge force of any valve's springs, what the tick's length may take from
                                    ///< it (tabulate/valve_springs.hpp); 0: no surge
};

/// Fills the targets. Validates the definition first; nothing is written when it refuses.
///
/// Accuracy: docs/model.md "Tables". A grid divides a degree into 1, 2, 5, 10 or 20 segments, the fewest that keep the
/// pressure within 1e-5 of its peak (the torque: of the peak pressure on the crank radius), or 20; if the capacity is
/// too small, the bound is doubled until the segments fit. The report gives the remaining error. Float and double;
/// O(segments), about 100 ms on a desktop.
template <class Real>
Status tabulate(const EngineDefinition& engine, const TickOptions& options, const TableTargets<Real>& targets,
                TableReport* report = nullptr) noexcept;

namespace detail::part {
/// Maximum number of rows of a section, for numbers of cylinders, trains, wheels, their faults and
/// grid segments.
[[nodiscard]] constexpr std::size_t most_rows(SectionRows rows, std::size_t cylinders, std::size_t trains,
                                              std::size_t wheels, std::size_t wheel_faults,
                                              std::size_t gas_segments) noexcept {
  switch (rows) {
    case SectionRows::one:
      return 1;
    case SectionRows::gas_grid:
    case SectionRows::torque_grid:
    case SectionRows::cut_grid:
      return gas_segments;
    case SectionRows::cylinders:
      return cylinders;
    case SectionRows::trains:
      return trains;
    case SectionRows::lobes:
      return trains * std::size_t{kDegreesPerTurn};
    case SectionRows::wheels:
      return wheels;
    case SectionRows::edges:
      return wheels * std::size_t{kMaxTriggerEdges};
    case SectionRows::wheel_faults:
      return wheel_faults;
    case SectionRows::fault_edges:
      return wheel_faults * std::size_t{kMaxTriggerEdges};
  }
  return 0;
}

/// Room for the sections that a scene needs. 0 rows: none.
template <class S, std::size_t GasSegments>
struct RoomForScene {
  static constexpr std::size_t kGasSegments = GasSegments;
  template <class Section>
  static constexpr std::size_t kRows = Section::template needed<S>()
                                           ? most_rows(Section::kRows, S::cylinders.capacity, S::trains.capacity,
                                                       S::triggers.capacity, S::wheel_faults, GasSegments)
                                           : 0;
};
/// Room for every section of any engine.
struct RoomForAll {
  static constexpr std::size_t kGasSegments = kMaxGasSegments;
  template <class Section>
  static constexpr std::size_t kRows = most_rows(Section::kRows, kMaxCylinders, kMaxTrains, kMaxTriggerWheels,
                                                 kMaxWheelFaults, kMaxGasSegments);
};

template <class Thing, std::size_t N>
using OneOr = std::conditional_t<N == 1, Thing, Thing[N + (N == 0)]>;

template <class Real, class Room, class All = AllSections>
struct Stores;
/// The sections themselves, one base each.
template <class Real, class Room, class... Each>
struct Stores<Real, Room, List<void, Each...>>
    : If<(Room::template kRows<Each> > 0),
         typename Each::template Store<OneOr<typename Each::template Record<Real>, Room::template kRows<Each>>>>... {
  [[nodiscard]] TableTargets<Real> targets() noexcept {
    TableTargets<Real> to;
    to.gas_capacity = static_cast<int>(Room::kGasSegments);
    sections([&](auto section) {
      if constexpr (Room::template kRows<decltype(section)> == 1) {
        section.in(to) = &section.in(*this);
      } else if constexpr (Room::template kRows<decltype(section)> > 1) {
        section.in(to) = section.in(*this);
      }
    });
    return to;
  }
};
}  // namespace detail::part

/// The built sections that a tick may read.
template <class Real>
[[nodiscard]] constexpr Sections<Real> sections_of(const TableTargets<Real>& built) noexcept {
  Sections<Real> all;
  detail::sections([&](auto section) {
    if constexpr (section.kRead) section.in(all) = section.in(built);
  });
  return all;
}

/// Tables in RAM: the sections that a scene needs, and no others. Large (tens of kB to 1 MB): static or on the heap,
/// not on a stack.
///
///     static crankloop::TableStorage<float, MyScene> storage;
///     if (!storage.build(definition, {100e-6}).ok()) ...
///     engine.init(storage.tables());
///
/// Not copyable: engines point into it.
template <class Real, class S, std::size_t GasSegments = 4096>
class TableStorage {
  static_assert(GasSegments >= std::size_t{kDegreesPerCycle} && GasSegments <= kMaxGasSegments,
                "720 to 14400 gas segments");

 public:
  TableStorage() = default;
  TableStorage(const TableStorage&) = delete;
  TableStorage& operator=(const TableStorage&) = delete;

  /// Builds the tables. After a refusal the old tables are lost and init refuses tables(). No engine may run on them
  /// during the call, and every engine that used them must be initialised again.
  Status build(const EngineDefinition& engine, const TickOptions& options, TableReport* report = nullptr) noexcept {
    tables_ = {};
    if constexpr (detail::Needs<S>::any_valves) {
      if (engine.train_count > static_cast<int>(S::trains.capacity))
        return refuse("scene.trains", Reason::out_of_range);
    }
    if constexpr (detail::Needs<S>::any_triggers) {
      if (engine.trigger_count > static_cast<int>(S::triggers.capacity))
        return refuse("scene.triggers", Reason::out_of_range);
    }
    if constexpr (detail::Needs<S>::faulty_wheels) {
      if (engine.wheel_fault_count > static_cast<int>(S::wheel_faults))
        return refuse("scene.wheel_faults", Reason::out_of_range);
    }
    const TableTargets<Real> targets = stores_.targets();
    if (const Status refused = tabulate(engine, options, targets, report); !refused.ok()) return refused;
    tables_ = Tables<Real, S>(sections_of(targets));
    return {};
  }

  [[nodiscard]] const Tables<Real, S>& tables() const noexcept { return tables_; }

 private:
  detail::part::Stores<Real, detail::part::RoomForScene<S, GasSegments>> stores_;
  Tables<Real, S> tables_{};
};

}  // namespace crankloop
