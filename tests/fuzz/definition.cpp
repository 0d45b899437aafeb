// Any bytes as a definition: refused by validate() or set-up with a reason and a field, or tables on which an engine
// steps in finite numbers, through a whole cycle, at any speed.
#include <crankloop/tick/step.hpp>

#include "../support/field_names.hpp"
#include "fuzzed_engine.hpp"

using namespace crankloop;

namespace {

/// Little enough that set-up takes milliseconds, for fuzzing wants many; what is left out reads but a few fields that
/// are validated all the same.
struct OnlyValves : Scene {
  static constexpr Count cylinders = up_to<2>;
  static constexpr ValveModel valves = ValveModel::elastic;
  static constexpr Count trains = up_to<2>;
  static constexpr bool theoretical_lift = true;
  static constexpr bool valve_acceleration = true;
  static constexpr bool valve_forces = true;
  static constexpr bool valve_results = true;
};

/// It has no valves, and its tables the fingerprint of a definition that may have some.
struct NoValves : Scene {
  [[maybe_unused]] static constexpr Count cylinders = up_to<2>;  // its tables are built, and none of it runs
};

template <class Enum>
Enum one_of(fuzz::Bytes& bytes, Enum usual) {
  const auto how = bytes.take<std::uint8_t>();
  return how < 128 ? usual : static_cast<Enum>(how % 8);
}

ValveTrain train_of(fuzz::Bytes& bytes) {
  ValveTrain train = fuzz::some_train();
  Cam& cam = train.cam;
  cam.source = one_of(bytes, cam.source);
  const auto how = bytes.take<std::uint8_t>();
  cam.exponent_count = how < 200 ? 4 : how < 228 ? bytes.take<std::int8_t>() : bytes.take<std::int32_t>();
  if (cam.source != CamSource::polynomial) cam.point_count = bytes.take<std::int32_t>();  // and no rows
  for (double* x : {&cam.max_lift_m, &cam.half_angle_deg, &cam.exponents[0], &cam.exponents[1], &cam.exponents[2],
                    &cam.exponents[3], &cam.full_lift_deg, &cam.phase_rate_deg_s}) {
    *x = bytes.number(*x);
  }
  Rocker& rocker = train.rocker;
  rocker.kind = one_of(bytes, rocker.kind);
  rocker.cam_turns = one_of(bytes, rocker.cam_turns);
  rocker.pivot_to_pad_m = 39.61e-3, rocker.pivot_to_cam_m = 30.28e-3, rocker.pad_radius_m = 30e-3;
  rocker.screw_ball_m = 10e-3, rocker.stem_above_pivot_m = 1.65e-3;
  if (rocker.kind != RockerKind::ratio) rocker.pivot_to_screw_m = 33.28e-3;
  for (double* x :
       {&rocker.base_circle_m, &rocker.clearance_m, &rocker.ratio, &rocker.pivot_to_pad_m, &rocker.pivot_to_cam_m,
        &rocker.pad_radius_m, &rocker.pivot_to_screw_m, &rocker.screw_ball_m, &rocker.stem_above_pivot_m}) {
    *x = bytes.number(*x);
  }
  Valve& valve = train.valve;
  valve.head_area_m2 = 0;
  for (double* x : {&valve.valve_kg, &valve.spring_kg, &valve.rocker_inertia_kg_m2, &valve.spring_N_m,
                    &valve.spring_preload_N, &valve.train_N_m, &valve.train_damping_ratio, &valve.guide_damping_ratio,
                    &valve.seat_N_m, &valve.seat_damping_ratio}) {
    *x = bytes.number(*x);
  }
  return train;
}

template <class Real>
void set_up_and_step(const std::uint8_t* data, std::size_t size) {
  static TableStorage<Real, OnlyValves> tables;
  static TableStorage<Real, NoValves> without_valves;
  static Engine<Real, OnlyValves> engine;
  fuzz::Bytes bytes(data, size);
  EngineDefinition definition = fuzz::some_engine();
  Crank& crank = definition.crank;
  Masses& masses = definition.masses;
  definition.pressure.source = one_of(bytes, PressureSource::none);
  definition.train_count = bytes.take<std::uint8_t>() < 240 ? 1 : bytes.take<std::int8_t>();
  definition.layout.cylinders = bytes.take<std::uint8_t>() < 240 ? 2 : bytes.take<std::int8_t>();
  TickOptions options;
  options.valves.integrator = one_of(bytes, Integrator::rk4);
  double speed_rad_s = 500;
  for (double* x :
       {&speed_rad_s, &options.tick_s, &options.valves.accuracy_m, &crank.bore_m, &crank.crank_radius_m,
        &crank.rod_length_m, &crank.pin_offset_m, &crank.compression_ratio, &masses.piston_kg, &masses.rod_small_end_kg,
        &masses.rod_big_end_kg, &masses.crank_pin_equivalent_kg, &definition.layout.firing_deg[1],
        &definition.layout.bank_deg[1], &definition.layout.position_m[1], &definition.pressure.crankcase_Pa}) {
    *x = bytes.number(*x);
  }
  definition.trains[0] = train_of(bytes);
  definition.trains[1] = train_of(bytes);
  const Status bare = without_valves.build(definition, options);
  fuzz::must(bare.ok() || support::is_field(bare.field), "a refusal names a field of the library");
  Status status = tables.build(definition, options);
  if (status.ok()) {
    fuzz::must(bare.ok(), "what a scene with valves accepts, one without does");
    fuzz::must(tables.tables().drive->fingerprint == without_valves.tables().drive->fingerprint,
               "the fingerprint is the definition's, whatever the scene");
  }
  if (status.ok()) status = engine.init(tables.tables(), Phase{bytes.take<std::uint64_t>()});
  if (!status.ok()) {
    fuzz::must(support::is_field(status.field), "a refusal names a field of the library");
    return;
  }
  typename Engine<Real, OnlyValves>::Input in;
  std::memset(&in, 0, sizeof in);
  in.speed_rad_s = speed_rad_s >= -1e30 && speed_rad_s <= 1e30 ? static_cast<Real>(speed_rad_s) : Real{0};
  for (int i = 0; i < 100; ++i) fuzz::must_be_finite(engine.step(in));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  set_up_and_step<float>(data, size);
  set_up_and_step<double>(data, size);
  return 0;
}
