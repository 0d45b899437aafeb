// Free forces, pins and journals of a whole engine: docs/model.md "Balance".
#include <cstddef>

#include <crankloop/phase.hpp>
#include <crankloop/tabulate/elementary.hpp>
#include <crankloop/tabulate/mechanism.hpp>
#include <crankloop/tabulate/summary.hpp>

#include "cylinder_groups.hpp"

namespace crankloop {

using namespace detail;
namespace {

/// cos and sin of an angle in degrees, exact at multiples of 90, so that forces of a balanced engine cancel exactly.
struct Direction {
  double cosine;
  double sine;
};
[[nodiscard]] Direction direction(double deg) noexcept {
  while (deg >= 360) deg -= 360;
  while (deg < 0) deg += 360;
  if (deg == 0) return {1, 0};
  if (deg == 90) return {0, 1};
  if (deg == 180) return {-1, 0};
  if (deg == 270) return {0, -1};
  return {elementary::cos(deg * detail::kRadPerDegree), elementary::sin(deg * detail::kRadPerDegree)};
}

/// One order of d2x/da2 per crank radius: cosine cos(order a) + sine sin(order a).
struct Part {
  double cosine;
  double sine;
};
/// From the exact displacement, by the trapezoidal rule: its error falls like (lambda / 2)^kSamples, to rounding for
/// any rod that is not within a thousandth of the shortest possible. The second derivative of a harmonic is -order^2
/// times the harmonic.
[[nodiscard]] Part acceleration_part(const Crank& crank, int order) noexcept {
  constexpr int kSamples = 512;
  const bool in_line = crank.pin_offset_m == 0;  // then x = r (1 - cos a) + an even function of sin a
  if (in_line && order % 2 != 0) return {order == 1 ? 1.0 : 0.0, 0};
  double cosine = 0;
  double sine = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double a = 2 * elementary::kPi * i / kSamples;
    const double x = exact_pose(crank, a).displacement_m;
    cosine += x * elementary::cos(order * a);
    sine += x * elementary::sin(order * a);
  }
  const double scale = -2.0 / kSamples * order * order / crank.crank_radius_m;
  return {scale * cosine, in_line ? 0 : scale * sine};
}

/// Adds a force (up, lateral) = axis * (along_cos cos + along_sin sin) at a place along the shaft.
void add(RotatingVector<double>& t, double arm_m, double up_cos, double up_sin, double lateral_cos,
         double lateral_sin) noexcept {
  t.up_cos += up_cos;
  t.up_sin += up_sin;
  t.lateral_cos += lateral_cos;
  t.lateral_sin += lateral_sin;
  t.pitch_cos += arm_m * up_cos;
  t.pitch_sin += arm_m * up_sin;
  t.yaw_cos += arm_m * lateral_cos;
  t.yaw_sin += arm_m * lateral_sin;
}

/// Half the major axis of the ellipse (ac cos + as sin, bc cos + bs sin): the vector is the sum of a forward and a
/// backward rotating one.
[[nodiscard]] double peak(double ac, double as, double bc, double bs) noexcept {
  const double forward = square_root((ac + bs) * (ac + bs) + (as - bc) * (as - bc)) / 2;
  const double backward = square_root((ac - bs) * (ac - bs) + (as + bc) * (as + bc)) / 2;
  return forward + backward;
}

}  // namespace

double crankshaft_middle_m(const Layout& layout) noexcept {
  double least = layout.position_m[0];
  double most = layout.position_m[0];
  for (std::size_t k = 1; k < static_cast<std::size_t>(layout.cylinders); ++k) {
    if (layout.position_m[k] < least) least = layout.position_m[k];
    if (layout.position_m[k] > most) most = layout.position_m[k];
  }
  return (least + most) / 2;
}

Bearings<double> bearings_of(const EngineDefinition& engine) noexcept {
  const Layout& layout = engine.layout;
  const double r = engine.crank.crank_radius_m;
  Bearings<double> b{};
  double rods[kMaxCylinders] = {};
  double throw_deg[kMaxCylinders] = {};
  for (std::size_t k = 0; k < static_cast<std::size_t>(layout.cylinders); ++k) {
    const std::size_t pin = layout.pin[k];
    b.pin_of[k] = layout.pin[k];
    rods[pin] += 1;
    throw_deg[pin] = layout.throw_deg(static_cast<int>(k));
    if (pin + 1 > b.pins) b.pins = static_cast<std::uint32_t>(pin + 1);
  }
  for (std::size_t i = 0; i < b.pins; ++i) {
    const Direction d = direction(throw_deg[i] - throw_deg[0]);
    b.rods_kg_m[i] = rods[i] * engine.masses.rod_big_end_kg * r;
    b.throw_kg_m[i] = (engine.masses.crank_pin_equivalent_kg + rods[i] * engine.masses.rod_big_end_kg) * r;
    b.throw_cos[i] = d.cosine;
    b.throw_sin[i] = d.sine;
  }
  b.by_pin = detail::grouped(b.pin_of, static_cast<std::uint32_t>(layout.cylinders), b.pins);
  return b;
}

BlockLoad in_block(const EngineDefinition& engine, double engine_deg, double along_N, double across_N) noexcept {
  int cylinder = 0;  // of pin 0: a valid layout has one
  while (cylinder + 1 < engine.layout.cylinders && engine.layout.pin[static_cast<std::size_t>(cylinder)] != 0)
    ++cylinder;
  const Direction first_throw = direction(engine_deg + engine.layout.throw_deg(cylinder));
  return {along_N * first_throw.cosine - across_N * first_throw.sine,
          along_N * first_throw.sine + across_N * first_throw.cosine};
}

RotatingVector<double> reciprocating_order(const EngineDefinition& engine, int order) noexcept {
  const Layout& layout = engine.layout;
  const double reciprocating = engine.masses.reciprocating_kg() * engine.crank.crank_radius_m;
  const double middle = crankshaft_middle_m(layout);
  const Part part = acceleration_part(engine.crank, order);
  RotatingVector<double> t{};
  for (std::size_t k = 0; k < static_cast<std::size_t>(layout.cylinders); ++k) {
    const Direction axis = direction(layout.bank_deg[k]);
    const Direction f = direction(order * layout.firing_deg[k]);
    // -P_j = m_j d2x/da2 w^2 along the cylinder axis away from the crankshaft, with a = A - firing.
    const double along_cos = reciprocating * (part.cosine * f.cosine - part.sine * f.sine);
    const double along_sin = reciprocating * (part.cosine * f.sine + part.sine * f.cosine);
    add(t, layout.position_m[k] - middle, axis.cosine * along_cos, axis.cosine * along_sin, axis.sine * along_cos,
        axis.sine * along_sin);
  }
  return t;
}

Balance<double> balance_of(const EngineDefinition& engine) noexcept {
  const Layout& layout = engine.layout;
  const double r = engine.crank.crank_radius_m;
  const double middle = crankshaft_middle_m(layout);
  Balance<double> b{};
  b.first = reciprocating_order(engine, 1);
  b.second = reciprocating_order(engine, 2);
  double rods_on[kMaxCylinders] = {};
  for (std::size_t k = 0; k < static_cast<std::size_t>(layout.cylinders); ++k) rods_on[layout.pin[k]] += 1;
  for (std::size_t k = 0; k < static_cast<std::size_t>(layout.cylinders); ++k) {
    const double arm = layout.position_m[k] - middle;
    // Centrifugal force along the throw at A + bank - firing: the big end in the plane of its cylinder, and its share
    // of the crank pin.
    const Direction throw_at = direction(layout.throw_deg(static_cast<int>(k)));
    const double kg_m =
        (engine.masses.rod_big_end_kg + engine.masses.crank_pin_equivalent_kg / rods_on[layout.pin[k]]) * r;
    add(b.rotating, arm, kg_m * throw_at.cosine, -kg_m * throw_at.sine, kg_m * throw_at.sine, kg_m * throw_at.cosine);
  }
  return b;
}

Wave wave_of(double cosine, double sine) noexcept {
  return {square_root(cosine * cosine + sine * sine), elementary::atan2(sine, cosine) / detail::kRadPerDegree};
}

double peak_force_kg_m(const RotatingVector<double>& t) noexcept {
  return peak(t.up_cos, t.up_sin, t.lateral_cos, t.lateral_sin);
}

double peak_moment_kg_m2(const RotatingVector<double>& t) noexcept {
  return peak(t.pitch_cos, t.pitch_sin, t.yaw_cos, t.yaw_sin);
}

}  // namespace crankloop
