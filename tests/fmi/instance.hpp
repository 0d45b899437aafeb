// An FMU without a shared object: the class that the functions of both versions call, and a supply whose tables are
// made anew for its parameter.
#pragma once

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <crankloop/fmi/unit.hpp>
#include <crankloop/tabulate/tabulate.hpp>

#include "engines.hpp"
#include "four_pistons_fmu.hpp"
#include "scenes.hpp"
#include "support/engines.hpp"
#include "support/trigger_wheels.hpp"

namespace fmu {

using crankloop::detail::EngineShape;
using crankloop::detail::Variable;
using crankloop::fmi::kDiscard;
using crankloop::fmi::kError;
using crankloop::fmi::kOk;
using crankloop::fmi::Message;
using crankloop::fmi::Stage;

/// The four-cylinder diesel, its crank turned by forces, with two trigger wheels and one number that may be set: the
/// bore. Its tables are made in place, as those of an engine file are.
struct BoreSupply {
  using Real = double;
  using Scene = FreeRunning;
  static constexpr std::size_t kMaxParameters = 1;
  static constexpr double kBore_m = 0.095;

  bool open(const char*, Message& why) noexcept {
    storage = std::make_unique<crankloop::TableStorage<Real, Scene>>();
    const double as_defined[] = {kBore_m};
    return build(as_defined, why) != nullptr;
  }
  [[nodiscard]] EngineShape shape() const noexcept {
    return crankloop::detail::shape_of<Real, Scene>(storage->tables());
  }
  [[nodiscard]] double tick_s() const noexcept { return 1e-4; }
  [[nodiscard]] std::uint64_t identity() const noexcept { return 0x0123'4567'89AB'CDEF; }
  [[nodiscard]] std::size_t parameters() const noexcept { return 1; }
  [[nodiscard]] Variable parameter(std::size_t) const noexcept {
    return crankloop::detail::real("engine.crank.bore_m", "Bore");
  }
  [[nodiscard]] double parameter_default(std::size_t) const noexcept { return kBore_m; }
  void set_start_values(crankloop::Input<double, Scene>&, double&) const noexcept {}
  [[nodiscard]] const crankloop::Tables<Real, Scene>* build(const double* parameters, Message& why) noexcept {
    crankloop::EngineDefinition engine = crankloop::support::diesel_495();
    engine.crank.bore_m = parameters[0];
    engine.friction = {60e3, 100, 0.5};
    engine.machine = {1, 0.01, 1e-3, 0.02};
    engine.starter = {200, 60};
    const auto wheels = crankloop::tick_test::drawn_wheels();
    engine = crankloop::tick_test::with_wheels(engine, {wheels[0], wheels[5]});
    const crankloop::Status status = storage->build(engine, {tick_s(), {}});
    if (status.ok()) return &storage->tables();
    why.say("%s is refused", status.field);
    return nullptr;
  }

  std::unique_ptr<crankloop::TableStorage<Real, Scene>> storage;
};

/// The last message to the importer.
inline std::string& told() {
  static std::string text;
  return text;
}
inline crankloop::fmi::Logger logger() {
  crankloop::fmi::Logger logger;
  logger.send = [](const crankloop::fmi::Logger&, crankloop::fmi::Answer, const char*, const char* message) {
    told() = message;
  };
  logger.function = [] {};
  return logger;
}

/// An instance, through the functions that an importer's calls are answered by.
template <class Supply>
class Instance {
 public:
  using Unit = crankloop::fmi::Unit<Supply>;
  static constexpr std::uint32_t kVersion = 3;

  Instance() {
    crankloop::fmi::Instance<Supply>* const probe = new crankloop::fmi::Instance<Supply>{};
    Message why;
    EXPECT_TRUE(probe->open(nullptr, why)) << why.text;
    unit = Unit::create(kVersion, "an instance", crankloop::fmi::TokenText(probe->token()).text, nullptr, logger());
    probe->each([this](auto, const Variable& variable, auto&) { names_.push_back(indexed(variable)); });
    delete probe;
  }
  ~Instance() { Unit::destroy(unit, kVersion); }
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  void start(double start_s = 0) {
    ASSERT_EQ(unit->begin_initialization(start_s), kOk);
    ASSERT_EQ(unit->finish_initialization(), kOk) << told();
  }
  [[nodiscard]] std::uint32_t reference(const std::string& name) const {
    for (std::uint32_t i = 0; i < names_.size(); ++i) {
      if (names_[i] == name) return i;
    }
    ADD_FAILURE() << "no variable " << name;
    return ~0u;
  }
  void set(const std::string& name, double value) {
    const std::uint32_t which = reference(name);
    const auto kind = kind_of(which);
    ASSERT_EQ(unit->set(kind, &which, 1, &value, 1), kOk) << name << ": " << told();
  }
  [[nodiscard]] double get(const std::string& name) const { return value(reference(name)); }
  /// Of all variables but what an importer may set to anything.
  [[nodiscard]] std::vector<double> shown() const {
    std::vector<double> values;
    for (std::uint32_t i = 0; i < names_.size(); ++i) {
      if (!unit->instance.takes(i, kind_of(i)) && names_[i].compare(0, 6, "start.") != 0) values.push_back(value(i));
    }
    return values;
  }
  [[nodiscard]] std::vector<unsigned char> saved() const {
    std::vector<unsigned char> bytes(Unit::kStateBytes);
    unit->instance.save(bytes.data());
    return bytes;
  }
  [[nodiscard]] int restore(const std::vector<unsigned char>& bytes) {
    void* state = nullptr;
    const int read = unit->read_state(bytes.data(), bytes.size(), &state);
    const int set = read == kOk ? unit->set_state(state) : read;
    EXPECT_EQ(unit->free_state(&state), kOk);
    return set;
  }
  /// `count` ticks, one by one.
  void run(int count) {
    for (; count > 0; --count) {
      ASSERT_EQ(unit->step(unit->instance.time_s(), unit->instance.tick_s()), kOk) << told();
    }
  }

  Unit* unit = nullptr;

 private:
  [[nodiscard]] crankloop::detail::VariableKind kind_of(std::uint32_t which) const {
    using crankloop::detail::VariableKind;
    for (const VariableKind kind : {VariableKind::real, VariableKind::whole, VariableKind::truth}) {
      if (unit->instance.has(which, kind)) return kind;
    }
    ADD_FAILURE();
    return VariableKind::real;
  }
  [[nodiscard]] double value(std::uint32_t which) const { return unit->instance.number(which); }

  std::vector<std::string> names_;
};
using BoreFmu = Instance<BoreSupply>;
using PistonsFmu = Instance<crankloop::fmi::ExportedSupply>;

}  // namespace fmu
