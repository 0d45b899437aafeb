// The engine's forces against exact ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <crankloop/tabulate/summary.hpp>

#include "support/kept_engines.hpp"
#include "support/random.hpp"
#include "support/status.hpp"
#include "support/tick_oracle.hpp"

namespace crankloop::engine_forces_test {
namespace {

using namespace tick_test;
using support::Random;

template <class Real>
class EngineForces : public DieselEngine<Real> {};
TYPED_TEST_SUITE(EngineForces, BothReals, RealName);

/// The tick's forces against ExactEngine at the same angle and speed. `gas_error_Pa` is what the tables' pressure may
/// be off by.
template <class Real>
void expect_exact_forces(const EngineDefinition& engine, double gas_error_Pa, const char* what) {
  using S = Asking<kForces | kTorque>;
  ExactEngine exact;
  ASSERT_TRUE(accepted(exact.init(engine)));
  FullTables<Real> tables;
  ASSERT_TRUE(accepted(tables.build(engine, kTick_s)));
  Random random;
  const Crank& crank = engine.crank;
  const double area = kPi / 4 * crank.bore_m * crank.bore_m;
  const double r = crank.crank_radius_m;
  // Kinematics to 4e-7 or 2e-9 (tick_kinematics_test), and a few roundings of each product.
  const double relative = sizeof(Real) == 4 ? 1.2e-6 : 4e-9;
  Running<Real, S> run(tables);
  for (int draw = 0; draw < 3000; ++draw) {
    const double speed = random.between(-600, 600);
    run.engine.step(at_speed<Engine<Real, S>>(speed));
    const auto& out = run.engine.output();
    const auto deg = static_cast<double>(deg_of(run.engine.state().phase));
    const auto w = static_cast<double>(run.engine.state().speed_rad_s);
    const double inertia = engine.masses.reciprocating_kg() * r * w * w * 1.6;
    const double couple = std::fabs(engine.masses.rod_inertia_correction_kg_m2) * 0.6 * w * w / crank.rod_length_m;
    double torque = 0;
    double torque_tolerance = 0;
    for (int k = 0; k < engine.layout.cylinders; ++k) {
      const CylinderForces<double> want = exact.forces(k, deg, w);
      const CylinderForces<Real>& got = out.cylinder[k];
      const double gas = std::max(want.pressure_Pa, 1e5) * area;
      const double tolerance = gas_error_Pa * area + relative * (gas + inertia + couple);
      const auto near = [&](Real value, double exact_value, double allowed, const char* name) {
        ASSERT_NEAR(static_cast<double>(value), exact_value, allowed)
            << what << ", " << name << " of cylinder " << k << " at " << deg << " deg, " << w << " rad/s, "
            << random.trace(draw);
      };
      near(got.pressure_Pa, want.pressure_Pa, gas_error_Pa + relative * std::max(want.pressure_Pa, 1e5), "pressure");
      near(got.gas_force_N, want.gas_force_N, gas_error_Pa * area + relative * gas, "gas force");
      near(got.inertia_force_N, want.inertia_force_N, relative * inertia, "inertia force");
      near(got.total_force_N, want.total_force_N, tolerance, "total force");
      near(got.side_force_N, want.side_force_N, tolerance, "side force");
      near(got.rod_force_N, want.rod_force_N, 1.2 * tolerance, "rod force");
      near(got.radial_force_N, want.radial_force_N, 1.2 * tolerance, "radial force");
      near(got.tangential_force_N, want.tangential_force_N, 1.2 * tolerance, "tangential force");
      near(got.torque_Nm, want.torque_Nm, 1.2 * tolerance * r, "torque");
      near(got.tilting_moment_Nm, want.tilting_moment_Nm, tolerance * (r + crank.rod_length_m), "tilting moment");
      torque += want.torque_Nm;
      torque_tolerance += 1.2 * tolerance * r;
    }
    ASSERT_NEAR(static_cast<double>(out.torque_Nm), torque, torque_tolerance) << what << " at " << deg << " deg";
    ASSERT_NEAR(static_cast<double>(out.torque_Nm), exact.torque_Nm(deg, w), torque_tolerance)
        << what << " at " << deg << " deg";
  }
}

TYPED_TEST(EngineForces, ForcesAreTheExactOnesToTheTablesAccuracy) {
  using Real = TypeParam;
  const double peak_Pa = 70e5;
  expect_exact_forces<Real>(diesel_495(), 1.2e-5 * peak_Pa, "495");
  expect_exact_forces<Real>(uneven_v4(), 1.2e-5 * peak_Pa, "uneven V4");
  expect_exact_forces<Real>(without_gas(diesel_495()), 0, "495 without gas");
  EngineDefinition far_off = without_gas(uneven_v4());
  far_off.crank.pin_offset_m = -0.2 * far_off.crank.crank_radius_m;
  far_off.crank.rod_length_m = far_off.crank.crank_radius_m / 0.45;
  far_off.masses.rod_inertia_correction_kg_m2 = 0.02;
  expect_exact_forces<Real>(far_off, 0, "short rod, offset");
}

TYPED_TEST(EngineForces, TorqueReadFromCurvesIsTheSumOfTheForcesTorques) {
  using Real = TypeParam;
  for (const EngineDefinition& engine : {diesel_495(), uneven_v4(), without_gas(uneven_v4())}) {
    FullTables<Real> tables;
    ASSERT_TRUE(accepted(tables.build(engine, kTick_s)));
    Running<Real, Asking<kTorque, kByTable, true>> by_curve(tables);
    Running<Real, Asking<kTorque | kForces, kByTable, true>> by_forces(tables);
    const double area = kPi / 4 * 0.095 * 0.095;
    for (int tick = 0; tick < 3000; ++tick) {
      const auto in = drive_of<Real, Asking<kTorque, kByTable, true>>(tick);
      typename Engine<Real, Asking<kTorque | kForces, kByTable, true>>::Input same;
      same.speed_rad_s = in.speed_rad_s;
      same.load_ratio = in.load_ratio;
      const auto curve = static_cast<double>(by_curve.engine.step(in).torque_Nm);
      const auto forces = static_cast<double>(by_forces.engine.step(same).torque_Nm);
      // Two fits of the same: pressure to 1e-5 of its peak each (motored and heat), inertia to 3e-6 of m r^2 w^2
      // (tick_kinematics_test).
      const auto w = static_cast<double>(in.speed_rad_s);
      const double tolerance =
          4 * 0.0575 * (3e-5 * 70e5 * area) + 4 * (sizeof(Real) == 4 ? 3e-6 : 1e-8) * 1.32 * 0.0575 * 0.0575 * w * w;
      ASSERT_NEAR(curve, forces, tolerance) << tick;
    }
  }
}

TYPED_TEST(EngineForces, TorqueOfMeasuredPressuresIsTheirWorkOnTheVolumes) {
  // Two engines side by side, one of them with nothing but the crankcase's pressure in its cylinders: what their
  // torques differ by is the gas's, (p - p_0) dV/da, whoever adds it up.
  using Real = TypeParam;
  const auto gas_torque_is_work = [](const EngineDefinition& engine, auto scene) {
    using E = Engine<Real, decltype(scene)>;
    FullTables<Real> tables;
    ASSERT_TRUE(accepted(tables.build(engine, kTick_s)));
    Running<Real, decltype(scene)> fired(tables);
    Running<Real, decltype(scene)> at_rest(tables);
    Random random;
    const double area_m2 = kPi / 4 * engine.crank.bore_m * engine.crank.bore_m;
    for (int draw = 0; draw < 1000; ++draw) {
      auto in = at_speed<E>(random.between(-300, 300));
      auto idle = in;
      for (Real& pressure : in.pressure_Pa) pressure = static_cast<Real>(random.between(0.5e5, 60e5));
      for (Real& pressure : idle.pressure_Pa) pressure = static_cast<Real>(engine.pressure.crankcase_Pa);
      const auto torque_Nm = static_cast<double>(fired.engine.step(in).torque_Nm) -
                             static_cast<double>(at_rest.engine.step(idle).torque_Nm);
      const auto deg = static_cast<double>(deg_of(fired.engine.state().phase));
      double work_Nm = 0;
      for (std::size_t k = 0; k < static_cast<std::size_t>(engine.layout.cylinders); ++k) {
        const double slope_m =
            static_cast<double>(oracle_pose_at_deg(engine.crank, deg - engine.layout.firing_deg[k]).slope_m);
        work_Nm += (static_cast<double>(in.pressure_Pa[k]) - engine.pressure.crankcase_Pa) * area_m2 * slope_m;
      }
      // Of each cylinder: the kinematics' error (tick_kinematics_test) of 60 bar, and roundings of the masses' 2 kNm at
      // 300 rad/s.
      const double scale_Nm = 60e5 * area_m2 * engine.crank.crank_radius_m + 500;
      ASSERT_NEAR(torque_Nm, work_Nm, engine.layout.cylinders * (sizeof(Real) == 4 ? 1.2e-6 : 4e-9) * scale_Nm)
          << random.trace(draw);
    }
  };
  for (const EngineDefinition& engine : {diesel_495(), uneven_v4()}) {
    gas_torque_is_work(engine, Asking<kTorque, PressureGiven::by_input>{});
    gas_torque_is_work(engine, Asking<kTorque | kForces, PressureGiven::by_input>{});
  }
}

}  // namespace
}  // namespace crankloop::engine_forces_test
