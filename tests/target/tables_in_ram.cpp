// Tables that this very machine builds are those that the program printed: same fingerprint, same golden run.
#include <crankloop/tabulate/tabulate.hpp>

#include "golden.hpp"
#include "ohc_125_everything.hpp"
#include "report.hpp"

namespace target_check {
namespace {

/// tools/engines/ohc_125.ini, units divided as the program reads it: 52.4 / 1e3 is not 52.4e-3 to the last bit, and the
/// fingerprint tells.
crankloop::EngineDefinition ohc_125() noexcept {
  crankloop::EngineDefinition engine;
  engine.crank = {52.4 / 1e3, 28.9 / 1e3, 101 / 1e3, 0, 9.2, 15000 / (1e3 / 104.71975511965977)};
  engine.masses = {0.120, 0.035, 0.110, 0, 0, 0.003};
  engine.pressure.source = crankloop::PressureSource::wiebe;
  engine.pressure.crankcase_Pa = 100e3;
  crankloop::WiebeDiagram& gas = engine.pressure.wiebe;
  gas.intake_Pa = 95e3;
  gas.exhaust_Pa = 108e3;
  gas.start_of_combustion_deg = -18;
  gas.combustion_duration_deg = 55;
  gas.wiebe_m = 2;
  gas.compression_exponent = 1.32;
  gas.expansion_exponent = 1.27;
  gas.exhaust_valve_opens_deg = 130;
  gas.net_mep_Pa = 950e3;
  constexpr double kPer1000Rpm = 104.71975511965977;  // rad/s
  engine.friction = {60e3, 8 / (kPer1000Rpm / 1e3), 1.5 / (kPer1000Rpm * kPer1000Rpm / 1e3)};
  engine.machine.quadratic_Nm_s2 = 0.154 / (kPer1000Rpm * kPer1000Rpm);
  engine.starter = {35, 700 / (1e3 / kPer1000Rpm)};
  engine.train_count = 1;
  crankloop::Cam& cam = engine.trains[0].cam;
  cam.max_lift_m = 6.301099 / 1e3;
  cam.half_angle_deg = 74;
  cam.exponent_count = 4;
  cam.exponents[0] = 2, cam.exponents[1] = 10, cam.exponents[2] = 18, cam.exponents[3] = 26;
  cam.full_lift_deg = 470;
  crankloop::Rocker& rocker = engine.trains[0].rocker;
  rocker.pivot_to_pad_m = 39.61 / 1e3;
  rocker.pivot_to_cam_m = 30.28 / 1e3;
  rocker.base_circle_m = 12.5 / 1e3;
  rocker.pad_radius_m = 30 / 1e3;
  rocker.pivot_to_screw_m = 33.28 / 1e3;
  rocker.screw_ball_m = 10 / 1e3;
  rocker.stem_above_pivot_m = 1.65 / 1e3;
  rocker.clearance_m = 0.05 / 1e3;
  crankloop::Valve& valve = engine.trains[0].valve;
  valve.valve_kg = 0.033;
  valve.spring_kg = 0.06;
  valve.rocker_inertia_kg_m2 = 8.12 / 1e6;
  valve.spring_N_m = 40e3;
  valve.spring_preload_N = 205.8;
  valve.train_N_m = 11765e3;
  valve.train_damping_ratio = 0.1;
  valve.guide_damping_ratio = 0.003;
  valve.seat_N_m = 100000e3;
  valve.seat_damping_ratio = 0.1;
  return engine;
}

}  // namespace

void check_tables_in_ram(Report& report) noexcept {
  static crankloop::TableStorage<float, ohc_125_everything::Scene> storage;
  static crankloop::Engine<float, ohc_125_everything::Scene> from_ram;
  static ohc_125_everything::Engine from_flash;
  const crankloop::Status built = storage.build(ohc_125(), {20e-6});
  report.check(built.ok(), "tables are built on the target");
  report.check(built.ok() && from_ram.init(storage.tables()).ok(), "an engine takes the tables built on the target");
  report.check(from_ram.state().fingerprint == from_flash.state().fingerprint,
               "tables built on the target have the fingerprint of those in flash");
  report.check(golden_hash(from_ram, 1400) == golden_hash(from_flash, 1400),
               "tables built on the target give the bits of those in flash");
}

}  // namespace target_check
