// The engine file in an FMU's resources, its numbers as parameters that may be set before the start.
//
//     resources/engine.ini    complete, as `crankloop show` has it; the tables it names beside it
//     resources/tick_us.txt   the tick
//
// What belongs here: the file and its numbers. What does not: their use by FMI (crankloop/fmi/instance.hpp).
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <crankloop/fmi/instance.hpp>
#include <crankloop/tabulate/tabulate.hpp>

#include "../../engine_file/engine_file.hpp"
#include "../../engine_file/following_springs.hpp"
#include "../../files/stored_zip.hpp"
#include "../../files/units.hpp"
#include "../../loops/valve_tick_limit.hpp"

namespace crankloop::program {

using detail::EngineShape, detail::UnitOfName, detail::Variable;  // of the list of variables

/// A number of the file. "engine.crank.bore_mm", in the file's unit.
struct EngineNumber {
  std::string name;
  const Key* key;
  const UnitOfName* unit;
  double value;
};

class EngineSource {
 public:
  /// From an FMU's resources. Throws InputError.
  explicit EngineSource(const std::string& folder);

  /// From an engine file, equal to the source from resources_of(engine, tick_us), without writing them. Lines of
  /// messages are those of the resources.
  EngineSource(const EngineFile& engine, double tick_us);

  [[nodiscard]] const std::vector<EngineNumber>& numbers() const noexcept { return numbers_; }
  [[nodiscard]] const EngineFile& file() const noexcept { return file_; }
  [[nodiscard]] double tick_s() const noexcept { return tick_s_; }
  [[nodiscard]] std::uint64_t identity() const noexcept { return identity_; }  ///< hash of all bytes it was read from

  /// The engine with other numbers, one for each of numbers(). Throws InputError at the line of the file.
  [[nodiscard]] EngineFile with(const double* values) const;

 private:
  void collect_numbers();

  std::string path_;
  EngineFile file_;
  std::vector<EngineNumber> numbers_;
  double tick_s_ = 0;
  std::uint64_t identity_ = 0;
};

/// The resources of an FMU of this engine.
[[nodiscard]] std::vector<ZipEntry> resources_of(const EngineFile& engine, double tick_us);

/// Supplies the tables of an FMU of `crankloop fmu`: built from the engine file when it is instantiated, and again at
/// the start if a parameter was set (crankloop/fmi/instance.hpp defines a supply).
template <class AReal, class AScene>
class FileSupply {
 public:
  using Real = AReal;
  using Scene = AScene;
  static constexpr std::size_t kMaxParameters = 256;

  bool open(const char* resources, fmi::Message& why) noexcept {
    if (resources == nullptr) return why.say("the folder of resources is missing"), false;
    return open_source(why, [resources] { return std::make_unique<EngineSource>(resources); });
  }
  [[nodiscard]] EngineShape shape() const noexcept { return detail::shape_of<Real, Scene>(storage_->tables()); }
  [[nodiscard]] double tick_s() const noexcept { return source_->tick_s(); }
  [[nodiscard]] std::uint64_t identity() const noexcept { return source_->identity(); }
  [[nodiscard]] std::size_t parameters() const noexcept { return source_ == nullptr ? 0 : source_->numbers().size(); }
  [[nodiscard]] Variable parameter(std::size_t i) const noexcept {
    const EngineNumber& number = source_->numbers()[i];
    Variable variable = detail::real(number.name.c_str(), number.key->meaning);
    variable.unit = number.unit;
    return variable.within(number.key->range.least, number.key->range.most);
  }
  [[nodiscard]] double parameter_default(std::size_t i) const noexcept { return source_->numbers()[i].value; }

  /// Start values of a running engine, for a simulation that sets nothing: its rated speed or the fastest that the tick
  /// allows, the file's fuel and burn, full throttle and load ratio, the file's own machine.
  void set_start_values(Input<double, Scene>& in, double& speed_rad_s) const noexcept {
    const double limit_rad_s = shape().speed_limit_rad_s;
    const double rated_rad_s = source_->file().rated_rpm() * kRad_sPerRpm;
    const double rad_s = rated_rad_s < limit_rad_s ? rated_rad_s : limit_rad_s;
    if constexpr (Scene::crank == CrankGiven::speed) in.speed_rad_s = rad_s;
    if constexpr (detail::Needs<Scene>::crank_dynamics) speed_rad_s = rad_s;
    const Gas& gas = source_->file().definition().gas;
    if constexpr (Scene::boundaries)
      in.ambient_Pa = gas.ambient_Pa, in.ambient_K = gas.ambient_K, in.back_Pa = gas.behind_outlet_Pa();
    if constexpr (detail::Needs<Scene>::burn_input) {
      for (std::uint32_t k = 0; k < Scene::cylinders.capacity; ++k) {
        in.fuel_kg[k] = gas.excess_air_ratio > 0 ? 0 : gas.fuel_kg;
        in.excess_air_ratio[k] = gas.excess_air_ratio;
        in.burn_start_deg[k] = gas.burn_start_deg;
        in.burn_duration_deg[k] = gas.burn_duration_deg;
        if constexpr (Scene::controller_names) in.spark_advance_deg[k] = -gas.burn_start_deg;
      }
    }
  }

  [[nodiscard]] const Tables<Real, Scene>* build(const double* values, fmi::Message& why) noexcept {
    bool as_built = built_;
    for (std::size_t i = 0; i < parameters(); ++i) as_built = as_built && values[i] == values_[i];
    return as_built || make_tables(values, why) ? &storage_->tables() : nullptr;
  }

 protected:
  /// `make_source()` returns a unique_ptr to an EngineSource.
  template <class MakeSource>
  bool open_source(fmi::Message& why, const MakeSource& make_source) noexcept {
    const bool good = told(why, [&] {
      source_ = make_source();
      if (parameters() > kMaxParameters) throw InputError("the engine file has more numbers than an FMU has room for");
      storage_ = std::make_unique<Storage>();
    });
    if (!good) return false;
    for (std::size_t i = 0; i < parameters(); ++i) values_[i] = parameter_default(i);
    return make_tables(values_, why);
  }

 private:
  using Storage = TableStorage<Real, Scene, kMaxGasSegments>;

  template <class Work>
  static bool told(fmi::Message& why, const Work& work) noexcept {
    try {
      work();
      return true;
    } catch (const std::exception& error) {
      why.say("%s", error.what());
      return false;
    }
  }
  bool make_tables(const double* values, fmi::Message& why) noexcept {
    return told(why, [&] {
      const EngineFile engine = source_->with(values);  // after a refusal the old tables are kept
      built_ = false;
      const Status refused = storage_->build(with_springs_that_follow(engine.definition()), {source_->tick_s()});
      if (!refused.ok()) throw explain_tabulate(engine, refused, source_->tick_s());
      for (std::size_t i = 0; i < parameters(); ++i) values_[i] = values[i];
      built_ = true;
    });
  }

  std::unique_ptr<EngineSource> source_;
  std::unique_ptr<Storage> storage_;
  double values_[kMaxParameters]{};  ///< those of the tables
  bool built_ = false;
};

}  // namespace crankloop::program
