// The contact of cam and follower: against two bodies that are turned by differences and touch by brute force, against
// what a flat follower does by a formula, and Hertz's stress against its own force.
#include <crankloop/tabulate/cam_contact.hpp>

#include <gtest/gtest.h>

#include <cmath>

#include <crankloop/tabulate/valve_lift.hpp>

#include "support/brute_force_cam.hpp"
#include "support/status.hpp"
#include "support/test_valves.hpp"

namespace crankloop::cam_contact_test {
namespace {

using support::BruteForceCam;
using support::direct_rocker;
using support::kPi;
using support::kRadPerDeg;
using support::ohc_125_cam;
using support::ohc_125_rocker;
using support::polynomial_cam;
using support::Random;
using support::refuses;

struct Vector {
  double x, y;
};
Vector operator+(Vector a, Vector b) { return {a.x + b.x, a.y + b.y}; }
Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.y - b.y}; }
Vector operator*(double k, Vector a) { return {k * a.x, k * a.y}; }
double dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y; }
double cross(Vector a, Vector b) { return a.x * b.y - a.y * b.x; }
Vector turned(Vector a, double rad) {
  return {std::cos(rad) * a.x - std::sin(rad) * a.y, std::sin(rad) * a.x + std::cos(rad) * a.y};
}
Vector direction(double rad) { return {std::cos(rad), std::sin(rad)}; }

/// Cam and rocker of brute_force_cam.hpp as bodies: the cam's centre is the origin, the pivot lies on the x axis.
class Bodies {
 public:
  Bodies(const CamProfile& cam, const Rocker& rocker)
      : sense_{rocker.cam_turns == CamTurns::toward_pivot ? 1.0 : -1.0}, brute_{rocker, [&cam](double phi) {
                                                                                  return cam.at(phi).lift_m;
                                                                                }} {}

  /// By differences over the cam's turn from full lift; no derivative of the lift enters but by three points of the
  /// contour.
  [[nodiscard]] ContactPose contact_at(double cam_rad) const {
    constexpr double h = 2e-3;
    const At here = at(cam_rad), before = at(cam_rad - h), after = at(cam_rad + h);
    const Vector n = direction(here.normal_rad);
    const Vector t = -sense_ * Vector{-n.y, n.x};  // as the cam's surface moves
    const Vector pivot{brute_.rocker.pivot_to_cam_m, 0};
    const Vector of_cam = 1 / (2 * h) * (turned(here.contact, -sense_ * h) - turned(here.contact, sense_ * h));
    const Vector arm = here.contact - pivot;  // the rocker turns clockwise as it lifts
    const double swing = (after.rocker_rad - before.rocker_rad) / 2;
    const Vector of_rocker = 1 / (2 * h) * (turned(arm, -swing) - turned(arm, swing));
    const Vector of_contact = 1 / (2 * h) * (after.contact - before.contact);
    const double entrainment_m = (dot(of_cam - of_contact, t) + dot(of_rocker - of_contact, t)) / 2;
    return {curvature(here.phi_rad) + 1 / brute_.rocker.pad_radius_m,
            -sense_ * cross(here.contact, n),  // of the force that resists the cam

            dot(of_cam - of_rocker, t), entrainment_m};
  }

 private:
  struct At {
    double rocker_rad, phi_rad, normal_rad;
    Vector contact;
  };

  [[nodiscard]] At at(double cam_rad) const {
    const double turned_rad = brute_.turned_at_full_lift_rad() + cam_rad;
    const double W = brute_.rocker_rad(turned_rad);
    const double phi = brute_.touch(W, turned_rad).phi_rad;
    const double normal_rad = sense_ * (phi - turned_rad);
    const Rocker& r = brute_.rocker;
    const Vector pad = Vector{r.pivot_to_cam_m, 0} + r.pivot_to_pad_m * Vector{-std::cos(W), std::sin(W)};
    return {W, phi, normal_rad, pad - r.pad_radius_m * direction(normal_rad)};
  }

  /// Of the circle through three points of the contour, each where two flat followers meet that are a little apart.
  [[nodiscard]] double curvature(double phi) const {
    constexpr double h = 2e-3;
    const auto point = [this](double of) {
      const double y = brute_.rocker.base_circle_m + brute_.follower_lift_m(BruteForceCam::wrapped(of));
      const double slope = (brute_.follower_lift_m(BruteForceCam::wrapped(of + 1e-4)) -
                            brute_.follower_lift_m(BruteForceCam::wrapped(of - 1e-4))) /
                           2e-4;
      return y * direction(of) + slope * direction(of + kPi / 2);
    };
    const Vector a = point(phi - h), b = point(phi), c = point(phi + h);
    const double area2 = cross(b - a, c - a);
    return 2 * area2 / std::sqrt(dot(b - a, b - a) * dot(c - b, c - b) * dot(c - a, c - a));
  }

  double sense_;
  BruteForceCam brute_;
};

void touches_as_bodies_do(const Cam& cam, const Rocker& rocker, double tolerance, double apart_rad,
                          const std::string& of) {
  ValveLift lift;
  ASSERT_TRUE(accepted(lift.init(cam, rocker))) << of;
  const Bodies bodies(lift.cam(), rocker);
  for (double rad = lift.opens_rad() + 0.05; rad < lift.closes_rad() - 0.05; rad += apart_rad) {
    const ContactPose is = lift.contact_at(rad);
    const ContactPose wanted = bodies.contact_at(rad);
    const double size_m = rocker.base_circle_m;
    EXPECT_NEAR(is.lever_m, wanted.lever_m, tolerance * size_m) << of << rad;
    EXPECT_NEAR(is.sliding_m, wanted.sliding_m, tolerance * size_m) << of << rad;
    EXPECT_NEAR(is.entrainment_m, wanted.entrainment_m, 3 * tolerance * size_m) << of << rad;
    EXPECT_NEAR(is.curvature_per_m, wanted.curvature_per_m, 3 * tolerance * wanted.curvature_per_m) << of << rad;
  }
}

// ---- where they touch ----

TEST(CamContactOf, TheRockerOfThe125SlidesAndRollsAsTwoTurnedBodiesDoEitherWay) {
  for (const CamTurns turns : {CamTurns::toward_pivot, CamTurns::away_from_pivot})
    touches_as_bodies_do(ohc_125_cam(), ohc_125_rocker(turns), 1e-4, 0.17,
                         turns == CamTurns::toward_pivot ? "to " : "off ");
}

TEST(CamContactOf, AnyTrainThatCanTurnSlidesAndRollsAsTwoTurnedBodiesDo) {
  Random random;
  support::each_random_train(random, 12,
                             [](const Cam& cam, const Rocker& rocker, const ValveLift&, const std::string& trace) {
                               touches_as_bodies_do(cam, rocker, 1e-3, 0.7, trace + ", ");
                             });
}

TEST(CamContactOf, AFlatFollowerSlidesWithTheSupportOfItsCam) {
  // v_s = w (r_0 + y), u = w (r_0 + y + 2 y'') / 2
  constexpr double kRounding_m = 1e-15;
  const Cam cam = polynomial_cam(6e-3, 70, {2, 4, 6, 8});
  CamProfile profile;
  ASSERT_TRUE(accepted(profile.init(cam)));
  for (const double ratio : {1.0, 1.6}) {
    ValveLift lift;
    ASSERT_TRUE(accepted(lift.init(cam, direct_rocker(30e-3, 0.1e-3, ratio))));
    for (double rad = -1.2; rad <= 1.2; rad += 0.07) {
      const CamLift y = profile.at(rad);
      const ContactPose is = lift.contact_at(rad);
      EXPECT_NEAR(is.curvature_per_m, 1 / (30e-3 + y.lift_m + y.per_rad2_m), 1e-9);
      EXPECT_NEAR(is.lever_m, y.per_rad_m, kRounding_m);
      EXPECT_NEAR(is.sliding_m, 30e-3 + y.lift_m, kRounding_m);
      EXPECT_NEAR(is.entrainment_m, (30e-3 + y.lift_m + 2 * y.per_rad2_m) / 2, kRounding_m);
    }
  }
}

TEST(CamContactOf, TheBaseCircleIsThatOfACircleAndAPadAtRest) {
  ValveLift lift;
  const Rocker rocker = ohc_125_rocker();
  ASSERT_TRUE(accepted(lift.init(ohc_125_cam(), rocker)));
  const ContactPose is = lift.contact_at(kPi);
  EXPECT_EQ(is.lever_m, 0);
  EXPECT_EQ(is.sliding_m, rocker.base_circle_m);
  EXPECT_EQ(is.entrainment_m, rocker.base_circle_m / 2);
  EXPECT_EQ(is.curvature_per_m, 1 / rocker.base_circle_m + 1 / rocker.pad_radius_m);
}

TEST(CamContactOf, TheLeverTimesTheRockerRatioIsTheValvesSlope) {
  ValveLift lift;
  ASSERT_TRUE(accepted(lift.init(ohc_125_cam(), ohc_125_rocker())));
  for (double rad = -1.4; rad < 1.1; rad += 0.03) {
    const LiftPose pose = lift.at(rad);
    EXPECT_NEAR(lift.contact_at(rad).lever_m * pose.rocker_ratio, pose.per_rad_m, 1e-15) << rad;
  }
}

TEST(CamContactOf, ACamThatWouldBeHollowIsRefusedByItsUndercut) {
  // A flat follower's lift cannot describe a hollow flank: rho = r_0 + y + y'' is above 0 or the contour has a cusp. So
  // 1/R > 0 wherever a lift is accepted.
  const Cam cam = polynomial_cam(8e-3, 40, {2, 4, 6, 8});
  ValveLift lift;
  const Status refused = lift.init(cam, direct_rocker(2e-3, 0));
  EXPECT_TRUE(refuses(refused, Reason::inconsistent, "rocker.base_circle_m"));
  CamProfile profile;
  ASSERT_TRUE(accepted(profile.init(cam)));
  const CamLift worst = profile.at(lift.failed_at_deg() * kRadPerDeg);
  EXPECT_LT(2e-3 + worst.lift_m + worst.per_rad2_m, 0);
}

// ---- Hertz ----

CamContact of_width(double width_m) {
  CamContact contact;
  contact.width_m = width_m;
  return contact;
}

TEST(HertzContactOf, TwoSteelCylindersUnder2000N) {
  const CamContact contact = of_width(8e-3);
  const double per_m = 1 / 15e-3 + 1 / 30e-3;
  const HertzContact is = hertz_contact(contact, per_m, 2000);
  EXPECT_NEAR(is.largest_Pa, 949.06e6, 0.005e6);
  EXPECT_NEAR(is.half_width_m, 167.70e-6, 0.005e-6);
  EXPECT_NEAR(kPi / 2 * is.largest_Pa * is.half_width_m * 8e-3, 2000, 1e-9);
  EXPECT_NEAR(contact_modulus_Pa(contact), 206e9 / (2 * (1 - 0.3 * 0.3)), 1e-3);
  EXPECT_EQ(hertz_contact(contact, per_m, 0).largest_Pa, 0);
  EXPECT_EQ(hertz_contact(contact, per_m, 0).half_width_m, 0);
}

TEST(HertzContactOf, ASofterFollowerIsStressedLess) {
  CamContact contact = of_width(8e-3);
  const double steel_Pa = hertz_contact(contact, 100, 2000).largest_Pa;
  contact.follower_Pa = 100e9;
  contact.follower_poisson_ratio = 0.25;
  // 1/E* is a sum, and p_max goes with the root of E*.
  const double modulus_Pa = 1 / ((1 - 0.09) / 206e9 + (1 - 0.0625) / 100e9);
  EXPECT_NEAR(hertz_contact(contact, 100, 2000).largest_Pa / steel_Pa, std::sqrt(modulus_Pa / (206e9 / (2 * 0.91))),
              1e-14);
}

// ---- what is refused ----

TEST(CamContactDefinition, IsRefusedWithItsField) {
  EXPECT_TRUE(accepted(validate(CamContact{})));
  CamContact contact = of_width(-1e-3);
  EXPECT_TRUE(refuses(validate(contact), Reason::negative, "cam.width_m"));
  contact = of_width(1e-12);
  EXPECT_TRUE(refuses(validate(contact), Reason::out_of_range, "cam.width_m"));
  contact = of_width(10e-3);
  contact.friction_ratio = -0.1;
  EXPECT_TRUE(refuses(validate(contact), Reason::negative, "cam.friction_ratio"));
  contact.friction_ratio = 0.1, contact.cam_Pa = 0;
  EXPECT_TRUE(refuses(validate(contact), Reason::out_of_range, "material.cam_Pa"));
  contact.cam_Pa = 1e11, contact.follower_poisson_ratio = 0.6;
  EXPECT_TRUE(refuses(validate(contact), Reason::out_of_range, "material.follower_poisson_ratio"));
  contact.follower_poisson_ratio = 0.3, contact.follower_Pa = 1.01e13;
  EXPECT_TRUE(refuses(validate(contact), Reason::out_of_range, "material.follower_Pa"));
}

TEST(CamContactDefinition, OfATrainIsValidatedWithItsIndex) {
  EngineDefinition engine = valve_test::engine_with(valve_test::ohc_125_train());
  engine.contacts[1].width_m = -1;  // of no train
  EXPECT_TRUE(accepted(validate(engine)));
  engine.contacts[0].friction_ratio = 2;
  EXPECT_TRUE(refuses(validate(engine), Reason::out_of_range, "cam.friction_ratio", 0));
}

TEST(CamContactDefinition, IsNoPartOfTheFingerprint) {
  EngineDefinition engine = valve_test::engine_with(valve_test::ohc_125_train());
  const auto fingerprint = [&engine] {
    return valve_test::Rig<float>(engine, {100e-6, {}}).engine().tables()->drive->fingerprint;
  };
  const std::uint64_t without = fingerprint();
  engine.contacts[0] = of_width(9e-3);
  engine.contacts[0].friction_ratio = 0.1;
  EXPECT_EQ(fingerprint(), without);
}

}  // namespace
}  // namespace crankloop::cam_contact_test
