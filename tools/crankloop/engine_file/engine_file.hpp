// One engine from its file: read, checked, complete.
//
//     const EngineFile engine = read_engine_file(path, {"engine", "crank", "masses"});
//     const Status status = tabulate(engine.definition(), ...);
//     if (!status.ok()) throw engine.explain(status);
//
// What belongs here: an engine file's interface for commands. What does not: its keys (engine_file_key_list.hpp).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <crankloop/define/engine_definition.hpp>
#include <crankloop/tabulate/cam_profile.hpp>

#include "../files/error.hpp"
#include "balancer.hpp"
#include "engine_file_values.hpp"
#include "port_geometry.hpp"
#include "settings.hpp"
#include "spring_wire.hpp"

namespace crankloop::program {

inline constexpr std::size_t kMaxEngineFileBytes = std::size_t{1} << 20;

/// A valve train of the file: what it has of [cam NAME], [material NAME], [rocker NAME] and [valve NAME].
struct TrainOfFile {
  std::string name;
  ValveTrain definition;  ///< parts that the file lacks are all zero
  CamContact contact;
  double stress_limit_Pa = 0;  ///< of the contact; 0: the file has none
  PortOfTrain port;
  bool has_flow_curve = false;           ///< of the file; else the curve is that of a usual valve
  std::optional<SpringWire> wire;        ///< of its spring, where the file has one
  std::optional<PortGeometry> geometry;  ///< of the port, where the file has a diameter of the seat or the head
  bool has_cam = false;
  bool has_rocker = false;
  bool has_valve = false;
  std::vector<CamPoint> points;  ///< definition.cam points here
  std::vector<int> point_lines;
  std::string points_path;
  std::optional<CamRows> rows;  ///< of a cam whose smoothing_um is auto

  [[nodiscard]] bool complete() const noexcept { return has_cam && has_rocker && has_valve; }
};

/// A trigger wheel of the file, beside its definition.
struct TriggerOfFile {
  std::string name;
  std::vector<double> edges_deg;  ///< if the wheel is given by edges, its definition points here
};

class EngineFile {
 public:
  EngineFile(EngineFile&&) = default;
  EngineFile& operator=(EngineFile&&) = default;
  EngineFile(const EngineFile&) = delete;  // definition() points to the diagram's rows, which live here
  EngineFile& operator=(const EngineFile&) = delete;

  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  [[nodiscard]] const std::string& name() const { return section("engine").text("name"); }
  [[nodiscard]] double rated_rpm() const { return section("engine").number("rated_rpm"); }

  /// Valid, with [layout] and [pressure] at their defaults where the file has none. Masses are zero unless
  /// has("masses"), all is zero unless has("crank"). Pressure rows live as long as this object, also when it is moved.
  [[nodiscard]] const EngineDefinition& definition() const noexcept { return definition_; }

  /// Every NAME of a [cam], [rocker] or [valve], in the order of the file, each part valid. The complete ones are
  /// definition().trains, in the same order.
  [[nodiscard]] const std::vector<TrainOfFile>& trains() const noexcept { return trains_; }

  /// The NAME of every [trigger], in the order of definition().triggers.
  [[nodiscard]] const std::vector<TriggerOfFile>& triggers() const noexcept { return triggers_; }

  /// Rules of `--misfire 'cylinder=2 every=16'`, with the keys of [misfire N], in place of the file's for these
  /// cylinders. Throws as the reader of a file does.
  void set_misfires(const std::vector<std::string>& orders);
  [[nodiscard]] bool misfires() const noexcept;  ///< of any cylinder

  /// Counterweights and balance shafts, which are no part of the definition.
  [[nodiscard]] const std::vector<Balancer>& balancers() const noexcept { return balancers_; }

  /// One of the trains; throws InputError for an unknown name.
  [[nodiscard]] const TrainOfFile& train(const std::string& name) const;

  /// Titles are written as in the brackets: "masses", "cam intake".
  [[nodiscard]] bool has(const std::string& title) const noexcept { return find(title) != nullptr; }
  [[nodiscard]] const SectionValues& section(const std::string& title) const;

  /// Throws InputError if a section that the command needs is missing.
  void require(const std::vector<std::string>& needed_sections) const;

  /// All sections in the order of `show`: those of the file, and those with defaults only.
  [[nodiscard]] const std::vector<SectionValues>& sections() const noexcept { return sections_; }

  /// The message for a refusal by core, at the line of the key that caused it.
  [[nodiscard]] InputError explain(const Status& status) const;

  /// The message for a refusal of a valve train by core; `cam_deg`: the cam angle of a refusal by ValveLift.
  [[nodiscard]] InputError explain(const Status& status, const TrainOfFile& train, double cam_deg = 0) const;

 private:
  friend EngineFile read_engine_text(const std::string&, const std::string&, const std::vector<std::string>&,
                                     const std::vector<Setting>&);

  explicit EngineFile(const std::string& path) : path_{path} {}
  [[nodiscard]] const SectionValues* find(const std::string& title) const noexcept;
  [[nodiscard]] SectionValues* find(const std::string& title) noexcept;
  void build_definition();
  void read_diagram(const SectionValues& pressure);
  void build_gas_exchange();
  void build_trains();
  void build_triggers();
  void build_misfires();
  void build_faults();
  void build_reluctor();
  void build_lambda_sensor();
  void build_sensor_faults();
  [[nodiscard]] int wheel_of(const SectionValues& section) const;
  [[nodiscard]] InputError explain_fault(const Status& status, const SectionValues& section) const;
  [[nodiscard]] const SectionValues* fault_to_blame(const Key& key, int index) const;
  [[nodiscard]] int train_with_phaser(const SectionValues& trigger) const;
  void read_cam(SectionValues& cam, TrainOfFile& train);
  [[nodiscard]] InputError explain_cam(const Status& status, const TrainOfFile& train, const SectionValues& cam) const;
  [[nodiscard]] const TrainOfFile* train_to_blame(const Key& key, int index) const;

  std::string path_;
  int last_line_ = 1;
  std::vector<SectionValues> sections_;
  EngineDefinition definition_;
  std::vector<DiagramPoint> points_;
  std::vector<int> point_lines_;
  std::string points_path_;
  std::vector<TrainOfFile> trains_;
  std::vector<TriggerOfFile> triggers_;
  std::vector<Balancer> balancers_;
};

/// A complete file without defaults. Reading it gives the same definition, and showing that the same text.
[[nodiscard]] std::string show(const EngineFile& engine);

/// Reads and validates everything in the file; throws InputError, also if a section that the command needs is missing.
[[nodiscard]] EngineFile read_engine_file(const std::string& path, const std::vector<std::string>& needed_sections);

/// Reads a text instead of the file: messages name `path`, and relative paths start at its folder. With `settings`, as
/// if the text had these values.
[[nodiscard]] EngineFile read_engine_text(const std::string& text, const std::string& path,
                                          const std::vector<std::string>& needed_sections,
                                          const std::vector<Setting>& settings = {});

}  // namespace crankloop::program
