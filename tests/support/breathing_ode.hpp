// A cylinder that breathes, with crevices, blow-by and runners, as ordinary differential equations in continuous time,
// by an adaptive integrator: shares no code with the library.
//
// docs/model.md "Gas". Between two manifolds that nothing changes; valves follow their cams. The crevice's flow is that
// which keeps its pressure the cylinder's: no step, no lag.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>

#include "support/adaptive.hpp"
#include "support/gas_engine.hpp"
#include "support/gas_equations.hpp"
#include "support/gas_reference.hpp"

namespace crankloop::support {

/// An engine between two manifolds that nothing changes, at a speed.
template <class Real, class S>
[[nodiscard]] std::unique_ptr<Breathing<Real, S>> breathing_between(const EngineDefinition& definition, double tick_s,
                                                                    double speed_rad_s, const GasSeen& intake,
                                                                    const GasSeen& exhaust) {
  auto run = std::make_unique<Breathing<Real, S>>(definition, tick_s);
  run->in.speed_rad_s = static_cast<Real>(speed_rad_s);
  run->in.intake_Pa = static_cast<Real>(intake.p), run->in.intake_K = static_cast<Real>(intake.t);
  run->in.exhaust_Pa = static_cast<Real>(exhaust.p), run->in.exhaust_K = static_cast<Real>(exhaust.t);
  return run;
}

class BreathingOde {
 public:
  /// What burns in a cycle by the definition's first law, the first one after a turn.
  struct Burn {
    double fuel_kg = 0;  ///< of no more than there is air for
    double heat_J = 0;   ///< without mass
  };

  BreathingOde(const EngineDefinition& engine, double speed_rad_s, const GasSeen& intake, const GasSeen& exhaust,
               const Burn& burn)
      : e_{engine},
        w_{speed_rad_s},
        burn_{burn},
        manifold_{intake, exhaust},
        places_(engine, speed_rad_s, 1),
        walls_(engine, speed_rad_s),
        by_(1e-9, scale()) {
    clearance_m3_ = places_.volume(0);
    const GasVolume gas = gas_filled(intake.p, intake.t, intake.x, places_.volume(0));
    y_ = {gas.m, gas.u, gas.b};
    y_[kWall] = engine.gas.wall_K;
    y_[kCreviceBurned] = per_Pa(y_) * intake.p * intake.x;
    for (std::size_t i = 0; i < 2; ++i) {
      if (!runner(i).any()) continue;
      const GasVolume port = gas_filled(manifold_[i].p, manifold_[i].t, manifold_[i].x, port_m3(i));
      y_[kRunners + 4 * i] = port.m, y_[kRunners + 4 * i + 1] = port.u, y_[kRunners + 4 * i + 2] = port.b;
    }
  }

  /// The crank from 0 where it stands at the start.
  void run_to(double time_s) {
    by_.run([this](double t, const auto& y, auto& dy) { slopes(t, y, dy); }, t_, time_s, y_);
  }

  /// The unburned gas is as all gas now; its temperature and knock_integral() go on from here.
  void begin_knock() {
    const GasSeen at = cylinder();
    y_[kUnburned] = at.t, y_[kKnock] = 0, unburned_x_ = at.x, knocks_ = true;
  }
  void end_knock() { knocks_ = false; }
  /// From here on, of no more than there is air for.
  void take_fuel(double kg) { burn_.fuel_kg = kg; }
  [[nodiscard]] double knock_integral() const { return y_[kKnock]; }
  [[nodiscard]] double unburned_K() const { return y_[kUnburned]; }

  /// Of the burn to come, or in progress.
  void burn_over(double duration_deg) { e_.gas.burn_duration_deg = duration_deg; }

  [[nodiscard]] double deg() const { return w_ * t_ * 180 / kPi; }
  [[nodiscard]] GasSeen cylinder() const { return gas_seen({y_[0], y_[1], y_[2]}, places_.volume(deg())); }
  [[nodiscard]] double mass_kg() const { return y_[0]; }
  [[nodiscard]] double crevice_kg() const { return per_Pa(y_) * cylinder().p; }
  [[nodiscard]] double wall_K() const { return y_[kWall]; }  ///< of the cylinder
  [[nodiscard]] double crevice_burned_kg() const { return y_[kCreviceBurned]; }
  [[nodiscard]] double blow_by_kg() const { return y_[kBlowBy]; }
  [[nodiscard]] double work_J() const { return y_[kWork]; }           ///< on the piston
  [[nodiscard]] double wall_heat_J() const { return y_[kWallHeat]; }  ///< crevices' walls included
  [[nodiscard]] double intake_kg() const { return y_[kIntakeMass]; }  ///< through the intake valve
  /// At a port; where there is a runner.
  [[nodiscard]] GasSeen port(std::size_t i) const { return seen_at_port(y_, i); }
  [[nodiscard]] double runner_kg_s(std::size_t i) const { return y_[kRunners + 4 * i + 3]; }

 private:
  enum At : std::size_t {
    kCreviceBurned = 3,
    kBlowBy,
    kWork,
    kWallHeat,
    kIntakeMass,
    kRunners,
    kUnburned = kRunners + 8,
    kKnock,
    kWall,
    kCount
  };
  using Vector = Adaptive<kCount>::Vector;

  static Vector scale() {
    return {1e-5, 10, 1e-6, 1e-6, 1e-6, 10, 10, 1e-5, 1e-5, 10, 1e-6, 1e-2, 1e-5, 10, 1e-6, 1e-2, 10, 0.1, 10};
  }
  [[nodiscard]] const Runner& runner(std::size_t i) const {
    return i == 0 ? e_.gas.intake_runner : e_.gas.exhaust_runner;
  }
  [[nodiscard]] double port_m3(std::size_t i) const { return 4 / (kPi * kPi) * runner(i).volume_m3(); }
  [[nodiscard]] GasSeen seen_at_port(const Vector& y, std::size_t i) const {
    const std::size_t at = kRunners + 4 * i;
    return gas_seen({y[at], y[at + 1], y[at + 2]}, port_m3(i));
  }
  /// Through the valves of a port, into the cylinder; answers that flow.
  double breathe(std::size_t i, double deg, const Vector& y, const GasSeen& at, GasVolume& d, Vector& dy) const {
    GasVolume from{0, 0, 0};
    const bool has_runner = runner(i).any();
    const GasSeen port = has_runner ? seen_at_port(y, i) : manifold_[i];
    const double through = gas_flow(OrificeLaw::ellipse, places_.area_of(i, deg), port, at, from, d);
    if (!has_runner) return through;
    const double w = y[kRunners + 4 * i + 3], area = runner(i).area_m2();
    const GasSeen& up = w >= 0 ? manifold_[i] : port;
    const double density = up.p / (kGasR * up.t), h = gas_enthalpy(up.t, up.x);
    const std::size_t to = kRunners + 4 * i;
    dy[to] = from.m + w, dy[to + 1] = from.u + w * h, dy[to + 2] = from.b + w * up.x;
    dy[to + 1] -= (i == 0 ? e_.gas.walls.intake_W_K : e_.gas.walls.exhaust_W_K) * (port.t - e_.gas.behind_walls_K());
    dy[to + 3] = area / runner(i).length_m *
                 (manifold_[i].p - port.p - runner(i).loss_ratio * w * std::fabs(w) / (2 * density * area * area));
    return through;
  }
  [[nodiscard]] double per_Pa(const Vector& y) const {
    return e_.gas.crevice.volume_ratio * clearance_m3_ / (kGasR * y[kWall]);
  }

  /// By how much dm, dU, db move the pressure.
  [[nodiscard]] static double moves(const GasVolume& gas, const GasSeen& at, double volume_m3, const GasVolume& d) {
    const double cv = gas_a(at.x) + kGasB * at.t;
    const double dt = (d.u - (646 * d.m + 93 * d.b) * at.t - kGasB / 2 * at.t * at.t * d.m) / (gas.m * cv);
    return kGasR / volume_m3 * (d.m * at.t + gas.m * dt);
  }

  void slopes(double t, const Vector& y, Vector& dy) const {
    const double deg = std::remainder(w_ * t * 180 / kPi, 720);
    const double step = 1e-3, volume = places_.volume(deg);
    const double volume_rate = (8 * (places_.volume(deg + step) - places_.volume(deg - step)) -
                                (places_.volume(deg + 2 * step) - places_.volume(deg - 2 * step))) /
                               (12 * step) * w_ * 180 / kPi;
    const GasVolume gas{y[0], y[1], y[2]};
    const GasSeen at = gas_seen(gas, volume);
    GasVolume d{0, 0, 0};
    dy = {};
    dy[kIntakeMass] = breathe(0, deg, y, at, d, dy);
    (void)breathe(1, deg, y, at, d, dy);
    const Gas& g = e_.gas;
    if (w_ * t > 2 * kPi) {
      const double rate =
          wiebe_slope((deg - g.burn_start_deg) / g.burn_duration_deg, g.wiebe_m) / g.burn_duration_deg * w_ * 180 / kPi;
      d.m += burn_.fuel_kg * rate, d.b += (1 + g.air_fuel_ratio) * burn_.fuel_kg * rate;
      d.u += (burn_.heat_J + burn_.fuel_kg * fuel_energy_J_kg(g)) * rate;
    }
    dy[kWallHeat] = walls_.W(at, volume, y[kWall]);
    dy[kWork] = at.p * volume_rate;
    d.u -= dy[kWallHeat] + dy[kWork];
    dy[kWall] = walls_warm_K_s(y, at, dy[kWallHeat]);
    if (g.crevice.any()) {
      const GasVolume without = d;
      const double heat_W = dy[kWallHeat];
      for (int i = 0; i < 3; ++i) {  // the walls' warmth lets gas out of the crevices, whose heat warms the walls
        d = without, dy[kWallHeat] = heat_W;
        fill_crevice(y, gas, at, volume, at.p * volume_rate / volume, d, dy);
        dy[kWall] = walls_warm_K_s(y, at, dy[kWallHeat]);
      }
    }
    dy[0] = d.m, dy[1] = d.u, dy[2] = d.b;
    if (!knocks_) return;
    const double rises = (moves(gas, at, volume, d) - at.p * volume_rate / volume) / at.p;
    dy[kUnburned] = y[kUnburned] * kGasR / (gas_a(unburned_x_) + kGasB * y[kUnburned] + kGasR) * rises;
    dy[kKnock] = 1 / knock_delay_s(g.octane_number, at.p, y[kUnburned]);
  }

  [[nodiscard]] double walls_warm_K_s(const Vector& y, const GasSeen& at, double heat_W) const {
    const Walls& walls = e_.gas.walls;
    if (walls.capacity_J_K == 0) return 0;
    const double crevice_J_K = per_Pa(y) * at.p * (646 + kGasB * y[kWall]) + 93 * y[kCreviceBurned];
    return (heat_W - walls.to_coolant_W_K * (y[kWall] - walls.coolant_K)) / (walls.capacity_J_K + crevice_J_K);
  }

  /// `falls_Pa_s`: the pressure by the volume's change at constant m T.
  void fill_crevice(const Vector& y, const GasVolume& gas, const GasSeen& at, double volume, double falls_Pa_s,
                    GasVolume& d, Vector& dy) const {
    const double wall_K = y[kWall], behind_Pa = e_.pressure.crankcase_Pa, per_Pa = this->per_Pa(y);
    const double held_kg = per_Pa * at.p;
    const double leak = e_.gas.crevice.blow_by_m2 *
                        (at.p >= behind_Pa ? ellipse(at.p, behind_Pa, wall_K) : -ellipse(behind_Pa, at.p, wall_K));
    const double rises = moves(gas, at, volume, d) - falls_Pa_s - at.p * dy[kWall] / wall_K;
    const auto flow = [&](double x, double kelvin) {
      const GasVolume unit{1, gas_enthalpy(kelvin, x), x};
      const double w = (per_Pa * rises + leak) / (1 + per_Pa * moves(gas, at, volume, unit));
      return GasVolume{w, w * unit.u, w * unit.b};
    };
    const bool fills = per_Pa * rises + leak > 0;
    const double own_x = held_kg > 0 ? y[kCreviceBurned] / held_kg : 0;
    const GasVolume out = fills ? flow(at.x, at.t) : flow(own_x, wall_K);
    d.m -= out.m, d.u -= out.u, d.b -= out.b;
    const double leak_x = held_kg > 0 ? own_x : std::fmax(0, at.x);
    dy[kBlowBy] = leak;
    dy[kCreviceBurned] = held_kg > 0 ? out.b - std::fmax(leak, 0) * leak_x : 0;
    // What comes in less what stays, at the walls' temperature, and what leaves with its enthalpy.
    const double stays = out.m - leak, stays_b = out.b - std::fmax(leak, 0) * leak_x;
    const double at_wall = 646 * wall_K + kGasB / 2 * wall_K * wall_K;
    dy[kWallHeat] +=
        out.u - (stays * at_wall + stays_b * 93 * wall_K) - leak * gas_enthalpy(wall_K, leak > 0 ? leak_x : 0);
  }

  EngineDefinition e_;
  double w_;
  Burn burn_;
  std::array<GasSeen, 2> manifold_;
  GasReference places_;
  WallHeat walls_;
  Adaptive<kCount> by_;
  double clearance_m3_ = 0, t_ = 0, unburned_x_ = 0;
  bool knocks_ = false;
  Vector y_{};
};

}  // namespace crankloop::support
