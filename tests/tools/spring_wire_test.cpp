// The wire of a valve spring: rate, mass and stress against energy, geometry and a worked example, its keys, and what
// `valve` says of it.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "crankloop/command_line/commands.hpp"
#include "crankloop/files/units.hpp"
#include "crankloop/loops/spring_stress.hpp"
#include "support/engine_files.hpp"
#include "support/files.hpp"

namespace crankloop::program::spring_wire_test {
namespace {

using support::kOhc125;

SpringWire wire_4_24() {
  SpringWire wire;
  wire.wire_m = 4e-3, wire.coil_m = 24e-3, wire.active_coils = 5.5, wire.shear_Pa = 79.3e9;
  return wire;
}

TEST(SpringWire, HasTheRateOfTheEnergyInItsTwistedWire) {
  // The force F twists each piece of the wire by F D / 2: energy sum T^2 ds / (2 G J) = F^2 / (2 k), J = pi d^4 / 32.
  const SpringWire wire = wire_4_24();
  const double force_N = 300, twists_Nm = force_N * wire.coil_m / 2;
  const double polar_m4 = kPi * std::pow(wire.wire_m, 4) / 32;
  double energy_J = 0;
  const int pieces = 1000;
  const double piece_m = kPi * wire.coil_m * wire.active_coils / pieces;
  for (int i = 0; i < pieces; ++i) energy_J += twists_Nm * twists_Nm * piece_m / (2 * wire.shear_Pa * polar_m4);
  EXPECT_NEAR(rate_of_wire_N_m(wire) / (force_N * force_N / (2 * energy_J)), 1, 1e-9);
  EXPECT_NEAR(mass_of_wire_kg(wire), 7850 * kPi * 4e-6 * piece_m * pieces, 1e-12);
}

TEST(SpringWire, HasTheStressOfAWorkedExample) {
  // C = 6: K_W = 23/20 + 0.1025 = 1.2525; tau = 8 500 0.024 1.2525 / (pi 6.4e-8).
  EXPECT_NEAR(shear_stress_Pa(wire_4_24(), 500) / 1e6, 598.02, 0.01);
  // Of a straight wire, twisted and sheared, as C grows: T r / J.
  SpringWire slim = wire_4_24();
  slim.coil_m = 4;
  const double straight_Pa = 500 * slim.coil_m / 2 * (slim.wire_m / 2) / (kPi * std::pow(slim.wire_m, 4) / 32);
  EXPECT_NEAR(shear_stress_Pa(slim, 500) / straight_Pa, 1, 2e-3);
}

TEST(SpringWire, IsSafeByGoodmansLine) {
  SpringWire wire = wire_4_24();
  wire.endurance_Pa = 300e6, wire.ultimate_Pa = 1200e6;
  EXPECT_NEAR(goodman_factor(wire, 400e6, 600e6), 1 / (100.0 / 300 + 500.0 / 1200), 1e-12);
  EXPECT_NEAR(goodman_factor(wire, 1200e6, 1200e6), 1, 1e-12);                               // breaks at rest
  EXPECT_NEAR(goodman_factor(wire, -50e6, 480e6), 1 / (240.0 / 300 + 240.0 / 1200), 1e-12);  // it only pushes
}

class SpringWireKeys : public EngineFileTest {
 protected:
  static std::string with(const std::string& lines) {
    return replaced(contents(kOhc125), "spring_preload_N = 205.8", lines + "\nspring_preload_N = 205.8");
  }
  std::string printed_by_valve(const std::string& lines) const {
    testing::internal::CaptureStdout();
    EXPECT_EQ(kValve.run(Arguments(kValve, {write("wire.ini", with(lines)), "--rpm", "6000"})), kSuccess);
    return testing::internal::GetCapturedStdout();
  }
  static double number(const std::string& summary, const std::string& name) {
    const std::size_t at = summary.find("\n" + name + " = ");
    EXPECT_NE(at, std::string::npos) << name;
    return at == std::string::npos ? 0 : std::stod(summary.substr(at + name.size() + 4));
  }
};

constexpr const char* kWire = "wire_mm = 4\ncoil_mm = 24\nactive_coils = 4.6\n";

TEST_F(SpringWireKeys, AreToldByValve) {
  const std::string limits = "shear_endurance_MPa = 310\nshear_ultimate_MPa = 1200\n";
  const std::string still = printed_by_valve(kWire + limits);
  SpringWire wire = wire_4_24();
  wire.active_coils = 4.6, wire.shear_Pa = 79e9;
  EXPECT_NEAR(number(still, "wire_spring_rate"), rate_of_wire_N_m(wire) / 1e3, 1e-3);
  EXPECT_NEAR(number(still, "wire_spring_mass"), mass_of_wire_kg(wire) * 1e3, 1e-3);
  EXPECT_NEAR(number(still, "wire_stress_closed"), shear_stress_Pa(wire, 205.8) / 1e6, 1e-2);
  const double open_N = 205.8 + 40 * number(still, "max_theoretical_lift");
  EXPECT_NEAR(number(still, "wire_stress_open"), shear_stress_Pa(wire, open_N) / 1e6, 1e-2);
  EXPECT_NEAR(number(still, "wire_stress_largest"), number(still, "wire_stress_open"), 3);
  EXPECT_NE(still.find("shear modulus assumed"), std::string::npos);
  // Surge swings further, and costs safety.
  const std::string surging = printed_by_valve(kWire + limits + "surge_modes = 2\n");
  EXPECT_GT(number(surging, "wire_stress_largest"), number(still, "wire_stress_largest") + 30);
  EXPECT_LT(number(surging, "goodman_factor"), number(still, "goodman_factor"));
  EXPECT_EQ(printed_by_valve(kWire).find("goodman"), std::string::npos);
  EXPECT_EQ(printed_by_valve("").find("wire_"), std::string::npos);
}

TEST_F(SpringWireKeys, AreRefusedByName) {
  const auto expect = [this](const std::string& lines, const char* words) {
    const std::string refused = refusal(with(lines));
    EXPECT_NE(refused.find(words), std::string::npos) << lines << ": " << refused;
  };
  expect("coil_mm = 24\n", "coil_mm: needs wire_mm beside it");
  expect("wire_mm = 4\ncoil_mm = 24\n", "wire_mm: needs active_coils beside it");
  expect("wire_mm = 4\ncoil_mm = 7\nactive_coils = 5\n", "coil_mm: 7 must be at least twice wire_mm = 4");
  expect(std::string(kWire) + "shear_ultimate_MPa = 1200\n", "shear_ultimate_MPa: needs shear_endurance_MPa beside it");
  expect(std::string(kWire) + "surge_modes = 1\ninner_spring_N_per_mm = 15\ninner_spring_g = 18\n",
         "wire_mm: is of one spring");
}

}  // namespace
}  // namespace crankloop::program::spring_wire_test
