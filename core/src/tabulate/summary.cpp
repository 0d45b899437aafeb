#include <crankloop/tabulate/summary.hpp>

#include <crankloop/phase.hpp>
#include <crankloop/tabulate/elementary.hpp>

#include "quadrature.hpp"

namespace crankloop {

using namespace detail;

using elementary::kPi;

namespace {
constexpr double kNoMean = 1e-9;  // of the torque's range: a smaller mean is a rounding error
}  // namespace

Body<double> body_of(const EngineDefinition& engine) noexcept {
  const Crank& c = engine.crank;
  Body<double> b{};
  b.crank_radius_m = c.crank_radius_m;
  b.per_crank_radius = 1 / c.crank_radius_m;
  b.per_rod_length = 1 / c.rod_length_m;
  b.pin_offset_m = c.pin_offset_m;
  const double reach = c.rod_length_m + c.crank_radius_m;
  b.height_at_tdc_m = square_root((reach - c.pin_offset_m) * (reach + c.pin_offset_m));
  b.bore_area_m2 = bore_area_m2(c);
  b.crankcase_Pa = engine.pressure.crankcase_Pa;
  b.reciprocating_kg = engine.masses.reciprocating_kg();
  b.rod_inertia_correction_kg_m2 = engine.masses.rod_inertia_correction_kg_m2;
  return b;
}

InertiaOrders inertia_orders(const EngineDefinition& engine, double crank_rad, double speed_rad_s) noexcept {
  const Crank& c = engine.crank;
  const double unit_N = -engine.masses.reciprocating_kg() * c.crank_radius_m * speed_rad_s * speed_rad_s;
  const double offset_ratio = c.pin_offset_m / c.rod_length_m;
  return {unit_N * (elementary::cos(crank_rad) + offset_ratio * elementary::sin(crank_rad)),
          unit_N * c.rod_ratio() * elementary::cos(2 * crank_rad)};
}

Status ExactEngine::init(const EngineDefinition& engine) noexcept {
  if (const Status refused = validate(engine); !refused.ok()) return refused;
  if (const Status refused = diagram_.init(engine.crank, engine.pressure); !refused.ok()) return refused;
  engine_ = engine;
  body_ = body_of(engine);
  return {};
}

CylinderForces<double> ExactEngine::forces(int cylinder, double engine_deg, double speed_rad_s,
                                           double load_ratio) const noexcept {
  const double own_deg = engine_deg - engine_.layout.firing_deg[static_cast<std::size_t>(cylinder)];
  const double pressure = diagram_.motored_Pa(own_deg) + load_ratio * diagram_.heat_Pa(own_deg);
  return cylinder_forces<true>(body_, exact_pose(engine_.crank, own_deg * detail::kRadPerDegree), pressure,
                               speed_rad_s);
}

double ExactEngine::torque_Nm(double engine_deg, double speed_rad_s, double load_ratio) const noexcept {
  double sum = 0;
  for (int k = 0; k < engine_.layout.cylinders; ++k) sum += forces(k, engine_deg, speed_rad_s, load_ratio).torque_Nm;
  return sum;
}

PinLoad ExactEngine::pin_load(int cylinder, double engine_deg, double speed_rad_s, double load_ratio) const noexcept {
  const double centrifugal_N = engine_.masses.rod_big_end_kg * engine_.crank.crank_radius_m * speed_rad_s * speed_rad_s;
  PinLoad load{};
  for (int k = 0; k < engine_.layout.cylinders; ++k) {
    if (engine_.layout.pin[static_cast<std::size_t>(k)] != engine_.layout.pin[static_cast<std::size_t>(cylinder)])
      continue;
    const CylinderForces<double> f = forces(k, engine_deg, speed_rad_s, load_ratio);
    load.radial_N += f.radial_force_N - centrifugal_N;
    load.tangential_N += f.tangential_force_N;
  }
  return load;
}

BrakeFigures brake_figures(const EngineDefinition& engine, double indicated_Nm, double speed_rad_s) noexcept {
  const double w = speed_rad_s < 0 ? -speed_rad_s : speed_rad_s;
  BrakeFigures b{};
  b.friction_mep_Pa =
      engine.friction.constant_Pa + w * (engine.friction.linear_Pa_s + w * engine.friction.quadratic_Pa_s2);
  const double friction_Nm = b.friction_mep_Pa * swept_volume_m3(engine.crank) * engine.layout.cylinders / (4 * kPi);
  b.torque_Nm = indicated_Nm - (speed_rad_s < 0 ? -friction_Nm : friction_Nm);
  b.power_W = b.torque_Nm * speed_rad_s;
  const double indicated_W = indicated_Nm * speed_rad_s;
  b.efficiency_ratio = indicated_W > 0 ? b.power_W / indicated_W : 0;
  return b;
}

void add_torques(CycleSummary& s, int samples, TorqueAt torque_Nm, const void* of) noexcept {
  double cosine[kHarmonics] = {};
  double sine[kHarmonics] = {};
  for (int i = 0; i < samples; ++i) {
    const double deg = i * (720.0 / samples);
    const double torque = torque_Nm(of, deg);
    if (i == 0 || torque > s.largest_torque_Nm) s.largest_torque_Nm = torque, s.largest_torque_deg = deg;
    if (i == 0 || torque < s.smallest_torque_Nm) s.smallest_torque_Nm = torque, s.smallest_torque_deg = deg;
    // cos and sin of multiples of half the angle by rotation: all orders from one pair.
    const double c1 = elementary::cos(deg / 2 * detail::kRadPerDegree);
    const double s1 = elementary::sin(deg / 2 * detail::kRadPerDegree);
    double c = c1;
    double si = s1;
    for (int h = 0; h < kHarmonics; ++h) {
      cosine[h] += torque * c;
      sine[h] += torque * si;
      const double next = c * c1 - si * s1;
      si = si * c1 + c * s1;
      c = next;
    }
  }
  for (int h = 0; h < kHarmonics; ++h) {
    const double c = cosine[h] * 2 / samples;
    const double si = sine[h] * 2 / samples;
    const Wave wave = wave_of(c, si);
    s.harmonics[h] = {(h + 1) / 2.0, c, si, wave.amplitude, wave.phase_deg};
  }
  const double range = s.largest_torque_Nm - s.smallest_torque_Nm;
  const bool has_mean = s.mean_torque_Nm > kNoMean * range || s.mean_torque_Nm < -kNoMean * range;
  s.fluctuation_ratio = has_mean ? range / s.mean_torque_Nm : 0;
}

CycleSummary summarise(const ExactEngine& engine, double speed_rad_s, double load_ratio) noexcept {
  CycleSummary s{};
  const EngineDefinition& definition = engine.definition();
  const DeadCentres centres = dead_centres(definition.crank);
  const double area = bore_area_m2(definition.crank);

  const auto loop_J = [&](double from_deg, double to_deg) {
    return detail::integrate(from_deg, to_deg, static_cast<int>((to_deg - from_deg) * 10), [&](double deg) {
      const double pressure = engine.diagram().motored_Pa(deg) + load_ratio * engine.diagram().heat_Pa(deg);
      return pressure * area * exact_pose(definition.crank, deg * detail::kRadPerDegree).slope_m *
             detail::kRadPerDegree;
    });
  };
  const double swept = swept_volume_m3(definition.crank);
  const double bdc_deg = centres.bdc_rad / detail::kRadPerDegree;
  const double closed_J = loop_J(bdc_deg - 360, bdc_deg);
  s.gross_mep_Pa = closed_J / swept;
  s.net_mep_Pa = (closed_J + loop_J(bdc_deg, bdc_deg + 360)) / swept;
  // Inertia does no work over a cycle, so the mean torque is that of the gas.
  s.mean_torque_Nm = s.net_mep_Pa * swept * definition.layout.cylinders / (4 * kPi);
  s.power_W = s.mean_torque_Nm * speed_rad_s;
  s.brake = brake_figures(definition, s.mean_torque_Nm, speed_rad_s);

  struct Point {
    const ExactEngine& engine;
    double speed_rad_s, load_ratio;
  };
  const Point point{engine, speed_rad_s, load_ratio};
  add_torques(
      s, 7200,
      [](const void* at, double deg) {
        const Point& p = *static_cast<const Point*>(at);
        return p.engine.torque_Nm(deg, p.speed_rad_s, p.load_ratio);
      },
      &point);
  return s;
}

}  // namespace crankloop
