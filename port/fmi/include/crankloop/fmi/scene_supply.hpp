// Where an FMU of crankloop_add_scene gets its tables: they are compiled in (fmi/instance.hpp: what a supply
// is).
#pragma once

#include <cstddef>
#include <cstdint>

#include <crankloop/fmi/instance.hpp>

namespace crankloop::fmi {

/// Of an engine of crankloop_add_scene: Made defines Real, Scene, Engine and kTick_s.
template <class Made>
struct SceneSupply {
  using Real = typename Made::Real;
  using Scene = typename Made::Scene;
  static constexpr std::size_t kMaxParameters = 0;

  bool open(const char*, Message& why) noexcept {
    const typename Made::Engine engine;
    tables = engine.tables();
    return tables != nullptr || (why.say("the tables do not suit the scene"), false);
  }
  [[nodiscard]] EngineShape shape() const noexcept { return shape_of<Real, Scene>(*tables); }
  [[nodiscard]] double tick_s() const noexcept { return Made::kTick_s; }
  [[nodiscard]] std::uint64_t identity() const noexcept { return tables->drive->fingerprint; }
  [[nodiscard]] std::size_t parameters() const noexcept { return 0; }
  [[nodiscard]] Variable parameter(std::size_t) const noexcept { return real("", ""); }
  [[nodiscard]] double parameter_default(std::size_t) const noexcept { return 0; }
  void set_start_values(Input<double, Scene>&, double&) const noexcept {}
  [[nodiscard]] const Tables<Real, Scene>* build(const double*, Message&) const noexcept { return tables; }

  const Tables<Real, Scene>* tables = nullptr;
};

}  // namespace crankloop::fmi
