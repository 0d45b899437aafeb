// The gas of an engine with gas exchange through its valves: manifolds, ports, walls, combustion.
//
// What belongs here: what a scene with PressureGiven::by_gas needs beyond the engine itself. What does not:
// what changes from tick to tick (throttle, fuel, spark: input.hpp). Equations: docs/model.md "Gas".
#pragma once

#include <cstdint>

#include <crankloop/define/field.hpp>
#include <crankloop/limits.hpp>
#include <crankloop/status.hpp>

namespace crankloop {

enum class GasPort : std::uint8_t { none, intake, exhaust };

inline constexpr int kMaxFlowPoints = 16;

/// What a valve train opens. All its valves are the same (Valve::per_cylinder).
struct PortOfTrain {
  GasPort port = GasPort::none;  ///< a train of an engine with gas exchange needs one
  double seat_diameter_m = 0;    ///< D, inner
  /// Flow coefficient times geometric area over pi/4 D^2, by the lift over D: discharge, curtain and port in one
  /// measured curve. Straight lines between, from 0 at 0; beyond the last the last. Lift ratios rise.
  int flow_count = 10;  ///< 2 to kMaxFlowPoints
  double flow_lift_ratio[kMaxFlowPoints] = {0, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.5};
  double flow_ratio[kMaxFlowPoints] = {0, 0.14, 0.27, 0.385, 0.47, 0.52, 0.555, 0.575, 0.59, 0.6};

  template <class Visit, class Self, class... Others>
  static constexpr void each_field(Visit&& visit, Self& self, Others&... others) {
    const bool any = self.port != GasPort::none;
    CRANKLOOP_FIELD(1, gas, port);
    CRANKLOOP_NUMBER(any ? 1 : 0, gas, seat_diameter_m, above(0).up_to(1));
    CRANKLOOP_FIELD(any ? 1 : 0, gas, flow_count);
    CRANKLOOP_NUMBER(any ? self.flow_count : 0, gas, flow_lift_ratio, from(0).up_to(0.5));
    CRANKLOOP_NUMBER(any ? self.flow_count : 0, gas, flow_ratio, from(0).up_to(1));
  }
};

/// The pipe between a manifold and the port of each cylinder, as one mass of gas with inertia and one volume at the
/// port.
struct Runner {
  double length_m = 0;  ///< 0.02 to 3; 0: none
  double diameter_m = 0;
  double loss_ratio = 0.5;  ///< zeta, pressure lost over the dynamic pressure: entrance, bends, wall friction

  [[nodiscard]] constexpr bool any() const noexcept { return length_m != 0; }
  [[nodiscard]] constexpr double area_m2() const noexcept { return 0.78539816339744831 * diameter_m * diameter_m; }
  [[nodiscard]] constexpr double volume_m3() const noexcept { return area_m2() * length_m; }

  template <class Visit, class Self, class... Others>
  static constexpr void each_field(Visit&& visit, Self& self, Others&... others) {
    const int read = self.any() ? 1 : 0;
    CRANKLOOP_NUMBER(1, runner, length_m, from(0).up_to(3));
    CRANKLOOP_NUMBER(read, runner, diameter_m, from(0.005).up_to(0.2));
    CRANKLOOP_NUMBER(read, runner, loss_ratio, from(0).up_to(10));
  }
};

/// Crevices of a cylinder (top land, ring pack, gasket, plug), and the leak past its rings.
struct Crevice {
  double volume_ratio = 0;  ///< their volume / clearance volume; 0: none
  double blow_by_m2 = 0;    ///< effective area of the leak into the crankcase; 0: tight

  [[nodiscard]] constexpr bool any() const noexcept { return volume_ratio != 0 || blow_by_m2 != 0; }

  template <class Visit, class Self, class... Others>
  static constexpr void each_field(Visit&& visit, Self& self, Others&... others) {
    CRANKLOOP_NUMBER(1, crevice, volume_ratio, from(0).up_to(0.1));
    CRANKLOOP_NUMBER(1, crevice, blow_by_m2, from(0).up_to(5e-6));
  }
};

/// Walls that warm up: docs/model.md "Walls".
struct Walls {
  // of each cylinder
  double capacity_J_K = 0;     ///< heat capacity, 1 and above; 0: fixed at Gas::wall_K
  double to_coolant_W_K = 20;  ///< conductance
  double coolant_K = 363.15;
  // of each manifold, or where there are runners of each port
  double intake_W_K = 0;  ///< conductance from the gas; 0: adiabatic
  double exhaust_W_K = 0;
  double manifold_K = 0;  ///< temperature behind them, at least 150; 0: Gas::ambient_K

  [[nodiscard]] constexpr bool any() const noexcept { return capacity_J_K != 0 || intake_W_K != 0 || exhaust_W_K != 0; }

  template <class Visit, class Self, class... Others>
  static constexpr void each_field(Visit&& visit, Self& self, Others&... others) {
    const int read = self.any() ? 1 : 0;
    CRANKLOOP_NUMBER(1, walls, capacity_J_K, from(0).up_to(1e6));
    CRANKLOOP_NUMBER(read, walls, to_coolant_W_K, from(0).up_to(1e5));
    CRANKLOOP_NUMBER(read, walls, coolant_K, from(150).up_to(2000));
    CRANKLOOP_NUMBER(1, walls, intake_W_K, from(0).up_to(1e5));
    CRANKLOOP_NUMBER(1, walls, exhaust_W_K, from(0).up_to(1e5));
    CRANKLOOP_NUMBER(read, walls, manifold_K, from(0).up_to(3000));
  }
};

/// A burn whose duration follows the charge: docs/model.md "Burn by charge". Its burn_start_deg is then where the spark
/// is, and burn_duration_deg how long it burns in the state of reference.
struct ChargeBurn {
  bool in_use = false;
  double spark_to_start_deg = 0;  ///< from spark to burn in the state of reference
  // the state of reference
  double reference_rad_s = 209.43951023931953;  ///< speed: 2000 rpm
  double reference_K = 650;
  double reference_Pa = 1300e3;
  double reference_burned_ratio = 0.05;  ///< burned share of the gas
  double reference_excess_air_ratio = 1;

  template <class Visit, class Self, class... Others>
  static constexpr void each_field(Visit&& visit, Self& self, Others&... others) {
    const int read = self.in_use ? 1 : 0;
    CRANKLOOP_FIELD(1, charge_burn, in_use);
    CRANKLOOP_NUMBER(read, charge_burn, spark_to_start_deg, from(0).up_to(40));
    CRANKLOOP_NUMBER(read, charge_burn, reference_rad_s, from(1).up_to(10500));
    CRANKLOOP_NUMBER(read, charge_burn, reference_K, from(300).up_to(1500));
    CRANKLOOP_NUMBER(read, charge_burn, reference_Pa, from(1e4).up_to(1e8));
    CRANKLOOP_NUMBER(read, charge_burn, reference_burned_ratio, from(0).up_to(0.3));
    CRANKLOOP_NUMBER(read, charge_burn, reference_excess_air_ratio, from(0.72).up_to(1.42));
  }
};

/// All pressures are absolute.
struct Gas {
  // manifolds, for scenes with a throttle
  double intake_m3 = 3000e-6;
  double exhaust_m3 = 2500e-6;
  double throttle_m2 = 1600e-6;       ///< effective area wide open
  double throttle_closed_m2 = 12e-6;  ///< 0 to the open one
  int throttle_count =
      4;  ///< 2 to kMaxFlowPoints: share of the area between closed and open, by the throttle ratio, straight lines
  double throttle_ratio[kMaxFlowPoints] = {0, 0.2, 0.5, 1};  ///< rising from 0 to 1
  double throttle_area_ratio[kMaxFlowPoints] = {0, 0.06, 0.3, 1};
  double outlet_m2 = 1200e-6;  ///< exhaust system as one orifice
  double ambient_Pa = 100e3;
  double back_Pa = 0;  ///< behind the outlet; at least 1e3, or 0: as ambient_Pa
  double ambient_K = 298.15;
  double exhaust_K = 773.15;  ///< of a given exhaust manifold, at first
  // walls
  double wall_K = 423.15;      ///< where walls warm up, at first
  double wall_heat_ratio = 1;  ///< k_w; 0 = adiabatic
  Crevice crevice;
  // combustion
  double fuel_kg = 30e-6;            ///< per cycle and cylinder; less than 1e-12 is none
  double excess_air_ratio = 0;       ///< lambda: fuel by the air in the cylinder, instead of fuel_kg; 0: fuel_kg
  double heating_value_J_kg = 43e6;  ///< lower
  double combustion_efficiency = 0.97;
  double air_fuel_ratio = 14.6;  ///< L, stoichiometric, by mass; kMaxMixtureHeat_J_kg bounds it too
  double latch_deg = -90;        ///< where a cylinder takes its cycle's fuel and burn
  double burn_start_deg = -18;
  double burn_duration_deg = 50;  ///< the burn ends by 150 deg
  double wiebe_m = 2;
  double second_ratio = 0;  ///< of the fuel that burns by a second law, from the same start (diesel)
  double second_m = 1;
  double second_duration_ratio = 3;  ///< of its duration to the first's
  PortOfTrain ports[kMaxTrains];
  Runner intake_runner, exhaust_runner;
  ChargeBurn charge_burn;
  Walls walls;
  double octane_number = 0;  ///< ON of the fuel, for the result knock: 60 to 120; 0: none

  /// Behind the walls of manifolds and runners.
  [[nodiscard]] constexpr double behind_walls_K() const noexcept {
    return walls.manifold_K > 0 ? walls.manifold_K : ambient_K;
  }
  /// Behind the outlet.
  [[nodiscard]] constexpr double behind_outlet_Pa() const noexcept { return back_Pa > 0 ? back_Pa : ambient_Pa; }

  /// The whole burn's duration, by that of the first law.
  [[nodiscard]] constexpr double span_ratio() const noexcept {
    return second_ratio > 0 && second_duration_ratio > 1 ? second_duration_ratio : 1;
  }

  template <class Visit, class Self, class... Others>
  static constexpr void each_field(Visit&& visit, Self& self, Others&... others) {
    CRANKLOOP_NUMBER(1, gas, intake_m3, above(0).up_to(100));
    CRANKLOOP_NUMBER(1, gas, exhaust_m3, above(0).up_to(100));
    CRANKLOOP_NUMBER(1, gas, throttle_m2, above(0).up_to(10));
    CRANKLOOP_NUMBER(1, gas, throttle_closed_m2, from(0).up_to(10));
    CRANKLOOP_FIELD(1, gas, throttle_count);
    CRANKLOOP_NUMBER(self.throttle_count, gas, throttle_ratio, from(0).up_to(1));
    CRANKLOOP_NUMBER(self.throttle_count, gas, throttle_area_ratio, from(0).up_to(1));
    CRANKLOOP_NUMBER(1, gas, outlet_m2, above(0).up_to(10));
    CRANKLOOP_NUMBER(1, gas, ambient_Pa, from(1e3).up_to(1e7));
    CRANKLOOP_NUMBER(1, gas, back_Pa, from(0).up_to(1e7));
    CRANKLOOP_NUMBER(1, gas, ambient_K, from(150).up_to(3000));
    CRANKLOOP_NUMBER(1, gas, exhaust_K, from(150).up_to(3000));
    CRANKLOOP_NUMBER(1, gas, wall_K, from(150).up_to(2000));
    CRANKLOOP_NUMBER(1, gas, wall_heat_ratio, from(0).up_to(100));
    CRANKLOOP_PART(1, crevice);
    CRANKLOOP_NUMBER(self.excess_air_ratio > 0 ? 0 : 1, gas, fuel_kg, from(0).up_to(0.01));
    CRANKLOOP_NUMBER(1, gas, excess_air_ratio, from(0).up_to(100));
    CRANKLOOP_NUMBER(1, gas, heating_value_J_kg, from(0).up_to(2e8));
    CRANKLOOP_NUMBER(1, gas, combustion_efficiency, from(0).up_to(1));
    CRANKLOOP_NUMBER(1, gas, air_fuel_ratio, from(1).up_to(100));
    CRANKLOOP_NUMBER(1, gas, latch_deg, from(-180).up_to(-90));
    CRANKLOOP_NUMBER(1, gas, burn_start_deg, from(-90).up_to(60));
    CRANKLOOP_NUMBER(1, gas, burn_duration_deg, from(5).up_to(150));
    CRANKLOOP_NUMBER(1, gas, wiebe_m, from(0).up_to(10));
    CRANKLOOP_NUMBER(1, gas, second_ratio, from(0).up_to(1));
    CRANKLOOP_NUMBER(1, gas, second_m, from(0).up_to(10));
    CRANKLOOP_NUMBER(1, gas, second_duration_ratio, from(0.1).up_to(10));
    CRANKLOOP_PART(kMaxTrains, ports);
    CRANKLOOP_PART(1, intake_runner);
    CRANKLOOP_PART(1, exhaust_runner);
    CRANKLOOP_PART(1, charge_burn);
    CRANKLOOP_PART(1, walls);
    CRANKLOOP_NUMBER(1, gas, octane_number, from(0).up_to(120));
  }
};

/// Most heat of a burn per kilogram of stoichiometric mixture, combustion_efficiency heating_value / (1 + L): more than
/// any fuel has. Petrol 2.8e6, hydrogen 3.4e6, nitromethane 4.2e6.
inline constexpr double kMaxMixtureHeat_J_kg = 5e6;

/// Where a burn must have ended, before the exhaust opens.
inline constexpr double kLatestBurn_deg = 150;

/// Field names "gas.*", of ports too, with the train in `index`, where the tables read them: `trains` of them;
/// "crevice.*", "charge_burn.*", "walls.*", and "runner.*" with the port in `index`.
Status validate(const Gas& gas, int trains) noexcept;

}  // namespace crankloop
