// What an engine file means once it is read. What is wrong with a file is told by tests/contract/bad_input_test.cpp;
// any bytes: hostile_engine_file_test.cpp.
#include "crankloop/engine_file/engine_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "crankloop/engine_file/plausibility.hpp"
#include "crankloop/engine_file/pressure_words.hpp"
#include "crankloop/files/error.hpp"
#include "crankloop/files/number.hpp"
#include "crankloop/files/text_file.hpp"
#include "crankloop/loops/valve_loop.hpp"
#include "lab/reference/valve_reference.hpp"
#include "support/engine_files.hpp"
#include "support/engines.hpp"
#include "support/status.hpp"
#include "support/units.hpp"

namespace crankloop::program::engine_file_test {
namespace {

/// The fields that no key is by itself, nor leads to.
class FieldsWithoutKey {
 public:
  template <class Field>
  void operator()(const ListedField& listed, const Field& field) {
    if constexpr (kHasFields<Field>) {
      Field::each_field(*this, field);
    } else if constexpr (std::is_same_v<Field, ValveTrain[kMaxTrains]> ||
                         std::is_same_v<Field, PortOfTrain[kMaxTrains]>) {
      (*this)(listed, field[0]);
    } else if (key_of_field(listed.name) == nullptr) {
      names_.push_back(listed.name);
    }
  }
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }

 private:
  std::vector<std::string> names_;
};

TEST_F(EngineFileTest, EveryFieldOfADefinitionHasItsKeyOrFollowsFromOthers) {
  FieldsWithoutKey without;
  without({1, ""}, EngineDefinition{});
  without({1, ""}, Gas{});
  EXPECT_EQ(without.names(), (std::vector<std::string>{"pressure.wiebe.heat_given", "train_count", "gas.latch_deg"}));
}

/// What the fields of a definition are where nobody sets them.
class DefaultOf {
 public:
  explicit DefaultOf(std::string_view name) : name_{name} {}
  template <class Field>
  void operator()(const ListedField& here, const Field& field) {
    if constexpr (std::is_array_v<Field>) {
      (*this)(here, field[0]);
    } else if constexpr (kHasFields<Field>) {
      Field::each_field(*this, field);
    } else if constexpr (std::is_same_v<Field, double> || std::is_same_v<Field, int>) {
      if (name_ == here.name) value = static_cast<double>(field);
    }
  }
  double value = std::numeric_limits<double>::quiet_NaN();

 private:
  std::string_view name_;
};

TEST_F(EngineFileTest, DefaultsAreThoseOfTheLibrary) {
  const EngineDefinition untouched{};
  int compared = 0;
  for (const SectionKind& kind : section_kinds()) {
    for (const Key* key : keys_of(kind.name)) {
      if (key->presence != Presence::with_default || key->field[0] == '\0') continue;
      DefaultOf library(key->field);
      EngineDefinition::each_field(library, untouched);
      Gas::each_field(library, untouched.gas);
      CamContact::each_field(library, untouched.contacts[0]);
      Misfire::each_field(library, untouched.misfires[0]);
      WheelFault::each_field(library, untouched.wheel_faults[0]);
      Reluctor::each_field(library, untouched.reluctor);
      LambdaSensor::each_field(library, untouched.lambda_sensor);
      SensorFault::each_field(library, untouched.sensor_faults[0]);
      EXPECT_EQ(parse_value(*key, key->fallback, "", 0).si(), library.value) << key->name;
      ++compared;
    }
  }
  EXPECT_GE(compared, 35);
}

constexpr const char* kBreathing = CRANKLOOP_SOURCE_DIR "/tools/engines/four_2000.ini";

TEST_F(EngineFileTest, AnEngineMayBreathe) {
  const EngineDefinition read_from = read_engine_file(kBreathing, {}).definition();
  EngineDefinition expected = support::four_2000();
  expected.crank.max_speed_rad_s = 300 * support::kPi;  // 9000 rpm
  expected.gas.throttle_closed_m2 = 6e-6;               // so that it idles
  expected.gas.excess_air_ratio = 1;
  expected.crank.max_speed_rad_s = 300 * support::kPi;  // 9000 rpm
  EXPECT_EQ(read_from.pressure.source, PressureSource::gas);
  ExpectSame{}({1, ""}, read_from.gas, expected.gas);
  ExpectSame{}({1, ""}, read_from.crank, expected.crank);
}

TEST_F(EngineFileTest, CurvesOfTheGasAreRowsOfPairs) {
  const std::string text = replaced(contents(kBreathing), "seat_diameter_mm = 33",
                                    "seat_diameter_mm = 33\nflow_over_lift_ratio = 0:0, 0.25 : 0.5 ,0.5:0.625");
  const PortOfTrain port = read(text).definition().gas.ports[0];
  EXPECT_EQ(port.flow_count, 3);
  EXPECT_EQ(port.flow_lift_ratio[1], 0.25);
  EXPECT_EQ(port.flow_ratio[1], 0.5);
  EXPECT_EQ(port.flow_ratio[2], 0.625);
}

TEST_F(EngineFileTest, GasThatCannotBeIsRefusedAtItsLine) {
  const std::string good = contents(kBreathing);
  const struct {
    const char *from, *to, *says;
  } cases[] = {
      {"port = intake\n", "", "[valve intake] lacks port, needed with [pressure] source = gas"},
      {"seat_diameter_mm = 28\n", "", "[valve exhaust] lacks seat_diameter_mm, needed with [pressure] source = gas"},
      {"burn_duration_deg = 50", "burn_duration_deg = 150\nburn_start_deg = 1", "given twice"},
      {"burn_start_deg = -18", "burn_start_deg = 60\nsecond_share = 0.5", "the burn would end at 210 deg"},
      {"1:1", "0.5:1", "throttle_curve: 0.5 follows 0.5; they must rise"},
      {", 1:1", ", 0.9:1", "throttle_curve: must end at 1"},
      {"0:0, 0.2", "0.1:0, 0.2", "throttle_curve: begins at 0.1; it must begin at 0"},
      {"0.2:0.06", "0.2", "entry 2: '0.2' is no pair"},
      {"0.2:0.06", "0.2:1.06", "entry 2: 1.06"},
      {"throttle_closed_mm2 = 6", "throttle_closed_mm2 = 2000", "throttle_closed_mm2: 2000 is more than"},
      {"burn_start_deg = -18", "air_fuel_ratio = 1.46",
       "air_fuel_ratio: 1.46 with heating_value_MJ_per_kg = 43 releases 16.9553 MJ per kg of mixture; allowed: up to "
       "5"},
      {"port = intake", "port = inlet", "port: 'inlet' is not one of intake, exhaust"},
  };
  for (const auto& one : cases) {
    EXPECT_NE(refusal(replaced(good, one.from, one.to)).find(one.says), std::string::npos)
        << one.to << ": " << refusal(replaced(good, one.from, one.to));
  }
  const std::string valveless = std::string(kOneCylinder) + "[pressure]\nsource = gas\n";
  EXPECT_NE(refusal(valveless).find("source: gas needs valves"), std::string::npos);
}

TEST_F(EngineFileTest, ASynthesisedDiagramNeedsNothingButItsWork) {
  const EngineFile engine = read(std::string(kOneCylinder) + "[pressure]\nsource = wiebe\nnet_mep_kPa = 800\n");
  EngineDefinition expected = engine.definition();
  expected.pressure = Pressure{};
  expected.pressure.source = PressureSource::wiebe;
  expected.pressure.wiebe.net_mep_Pa = 800e3;
  expect_same(engine.definition(), expected);
}

TEST_F(EngineFileTest, TheSampleDieselIsTheOneOfTheDesignSheet) {
  const EngineFile engine = read_engine_file(kSample, {"engine", "crank", "masses", "layout", "pressure"});
  EXPECT_EQ(engine.name(), "495 diesel");
  EXPECT_EQ(engine.rated_rpm(), 2000);
  const EngineDefinition& diesel = engine.definition();
  EXPECT_TRUE(accepted(validate(diesel)));
  EXPECT_EQ(diesel.crank.bore_m, 0.095);  // the double nearest to 0.095, not 95 times a rounded 0.001
  EXPECT_EQ(diesel.crank.crank_radius_m, 0.0575);
  EXPECT_NEAR(diesel.crank.rod_ratio(), 0.2738, 1e-16);
  EXPECT_EQ(diesel.crank.compression_ratio, 19);
  EXPECT_EQ(diesel.masses.reciprocating_kg(), 0.810 + 0.505);
  EXPECT_EQ(diesel.masses.rod_big_end_kg, 1.382);
  EXPECT_EQ(diesel.layout.cylinders, 4);
  EXPECT_EQ(diesel.layout.firing_deg[1], 540);  // 1-3-4-2
  EXPECT_EQ(diesel.layout.firing_deg[2], 180);
  EXPECT_EQ(diesel.layout.firing_deg[3], 360);
  EXPECT_EQ(diesel.layout.position_m[3], 0.36);
  // 8.8 kW of brake power per cylinder at 2000 rpm and a mechanical efficiency of 0.80, from 0.8151 L.
  const double displacement_m3 = support::kPi / 4 * 0.095 * 0.095 * 0.115;
  EXPECT_NEAR(diesel.pressure.wiebe.net_mep_Pa * displacement_m3 * 2000 / 120 * 0.80, 8800, 5);
}

TEST_F(EngineFileTest, BlanksCommentsAndLineEndsChangeNothing) {
  const std::string plain = contents(kSample);
  const EngineFile expected = read(plain);
  std::string windows = "\xEF\xBB\xBF";
  for (const char c : plain) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  std::string airy;
  std::istringstream lines(plain);
  for (std::string line; std::getline(lines, line);) airy += "\t " + line + " \t\t# \xC3\xBC\n\n";
  const std::string without_final_newline = plain.substr(0, plain.find_last_not_of('\n') + 1);
  for (const std::string& text : {windows, airy, without_final_newline}) {
    const EngineFile engine = read(text);
    expect_same(engine.definition(), expected.definition());
    EXPECT_EQ(show(engine), show(expected));
  }
}

/// The bits of a character in so many bytes: UTF-8 (RFC 3629) where they are the fewest that hold them, else an
/// overlong form.
std::string in_utf8_form(std::uint32_t code, int bytes) {
  if (bytes == 1) return std::string(1, static_cast<char>(code));
  std::string text;
  for (int i = 1; i < bytes; ++i, code >>= 6) text.insert(text.begin(), static_cast<char>(0x80u | (code & 0x3Fu)));
  text.insert(text.begin(), static_cast<char>((0xF00u >> bytes & 0xFFu) | code));
  return text;
}

TEST(TextFile, HoldsEveryCharacterOfUnicodeInItsShortestFormAndNothingElse) {
  const auto is_text = [](const std::string& bytes) {
    try {
      static_cast<void>(split_lines("a" + bytes + "z", "file"));
      return true;
    } catch (const InputError&) {
      return false;
    }
  };
  for (int bytes = 1; bytes <= 4; ++bytes) {
    const std::uint32_t forms = bytes == 1 ? 0x80u : 1u << (5 * bytes + 1);  // 11, 16, 21 bits
    for (std::uint32_t code = 0; code < forms;
         code += bytes < 4 || code < 0x11000u || (code >= 0x10FF00u && code < 0x111000u) ? 1 : 0x100u) {
      const int fewest = code < 0x80u ? 1 : code < 0x800u ? 2 : code < 0x10000u ? 3 : 4;
      const bool control = (code < 0x20u && code != '\t' && code != '\n') || (code >= 0x7Fu && code < 0xA0u);
      const bool surrogate = code >= 0xD800u && code < 0xE000u;
      const bool text = bytes == fewest && !control && !surrogate && code <= 0x10FFFFu;
      ASSERT_EQ(is_text(in_utf8_form(code, bytes)), text) << std::hex << "U+" << code << " in " << bytes << " bytes";
    }
  }
  for (unsigned first = 0x80; first <= 0xFF; ++first) {
    const std::string alone(1, static_cast<char>(first));
    EXPECT_FALSE(is_text(alone)) << first;
    if (first >= 0xF8) {
      EXPECT_FALSE(is_text(alone + "\x88\x80\x80\x80")) << first;
    }
  }
  EXPECT_FALSE(is_text("\xE2\x82")) << "cut off";
  EXPECT_FALSE(is_text("\xF0\x9F\x98")) << "cut off";
}

TEST_F(EngineFileTest, ANameMayHoldAHashThatFollowsNoBlank) {
  EXPECT_EQ(read(replaced(kOneCylinder, "single", "rig#2 \xE2\x84\x96 7 # the old one")).name(),
            "rig#2 \xE2\x84\x96 7");
}

TEST_F(EngineFileTest, WithoutLayoutAndPressureItIsOneCylinderWithoutGas) {
  const EngineFile engine = read(kOneCylinder);
  EXPECT_EQ(engine.definition().layout.cylinders, 1);
  EXPECT_EQ(engine.definition().pressure.source, PressureSource::none);
  EXPECT_EQ(engine.definition().pressure.crankcase_Pa, 100e3);
  EXPECT_EQ(engine.definition().crank.rod_length_m, 0.210);
  EXPECT_FALSE(engine.has("masses"));
}

TEST_F(EngineFileTest, AWholeRodIsLumpedOnItsEnds) {
  const std::string rod =
      "[masses]\npiston_g = 810\ncrank_inertia_kg_m2 = 0.5\nrod_g = 1887\nrod_com_to_crank_mm = 56.2\n";
  const Masses two_mass = read(kOneCylinder + rod).definition().masses;
  EXPECT_NEAR(two_mass.rod_small_end_kg + two_mass.rod_big_end_kg, 1.887, 1e-15);
  EXPECT_NEAR(two_mass.rod_small_end_kg * 0.210, 1.887 * 0.0562, 1e-16);  // same centre of mass
  EXPECT_EQ(two_mass.rod_inertia_correction_kg_m2, 0);                    // no inertia given: two-mass rod
  const Masses weighed = read(kOneCylinder + rod + "rod_inertia_kg_mm2 = 0\n").definition().masses;
  EXPECT_NEAR(weighed.rod_inertia_correction_kg_m2, -1.887 * 0.0562 * (0.210 - 0.0562), 1e-15);  // 0 is a value
}

TEST_F(EngineFileTest, PinAndWebsAreReducedToTheCrankRadius) {
  const std::string masses =
      std::string(kOneCylinder) +
      "[masses]\npiston_g = 810\nrod_small_end_g = 505\nrod_big_end_g = 1382\ncrank_inertia_kg_m2 = 0.5\n";
  const EngineFile drawn = read(masses + "crank_pin_g = 900\ncrank_web_g = 1400\ncrank_web_radius_mm = 21\n");
  EXPECT_NEAR(drawn.definition().masses.crank_pin_equivalent_kg * 0.0575, 0.9 * 0.0575 + 2 * 1.4 * 0.021, 1e-16);
  EXPECT_EQ(show(read(show(drawn))), show(drawn));
  EXPECT_EQ(show(drawn).find("crank_pin_equivalent_g"), std::string::npos);
  const EngineFile silent = read(masses);
  EXPECT_EQ(silent.definition().masses.crank_pin_equivalent_kg, 0);
  EXPECT_NE(show(silent).find("crank_pin_equivalent_g = 0"), std::string::npos) << "a default is shown";
}

TEST_F(EngineFileTest, CylindersStandABoreAndAFifthApartWhereNothingIsSaid) {
  const EngineFile engine = read(std::string(kOneCylinder) + "[layout]\ncylinders = 3\nfiring_order = 1-2-3\n");
  EXPECT_EQ(engine.section("layout").number("cylinder_spacing_mm"), 114);
  EXPECT_EQ(engine.definition().layout.position_m[2], 0.228);
  EXPECT_EQ(engine.definition().layout.pin[2], 2);
}

TEST_F(EngineFileTest, ACrossPlaneV8HasFourPinsWithTwoRodsEach) {
  const std::string v8 = std::string(kOneCylinder) +
                         "[layout]\ncylinders = 8\nfiring_order = 1-8-4-3-6-5-7-2\n"
                         "bank_angles_deg = 45,-45,45,-45,45,-45,45,-45\ncylinder_spacing_mm = 100\n";
  const EngineFile paired = read(v8 + "shared_pins = 1-2,3-4,5-6,7-8\n");
  const Layout& layout = paired.definition().layout;
  for (std::size_t k = 0; k < 8; ++k) {
    EXPECT_EQ(layout.pin[k], k / 2);
    EXPECT_EQ(layout.position_m[k], static_cast<double>(k / 2) / 10);  // spacing counts pins
  }
  EXPECT_EQ(paired.section("layout").numbers("crank_throws_deg"),
            (std::vector<double>{45, 45, 135, 135, 315, 315, 225, 225}));
  // The same engine by its positions: pins follow from equal position and throw.
  const EngineFile placed =
      read(replaced(v8, "cylinder_spacing_mm = 100", "cylinder_positions_mm = 0,0,100,100,200,200,300,300"));
  expect_same(placed.definition(), paired.definition());
  EXPECT_EQ(format_value(*placed.section("layout").find("shared_pins")), "1-2,3-4,5-6,7-8");
}

TEST_F(EngineFileTest, PinsAreNumberedAlongTheShaftWhateverTheCylindersAreCalled) {
  const std::string reversed = std::string(kOneCylinder) +
                               "[layout]\ncylinders = 4\nfiring_angles_deg = 0,90,270,360\n"
                               "bank_angles_deg = 45,135,-45,45\n";
  const std::string by_groups = reversed + "cylinder_positions_mm = 300,200,101,299\nshared_pins = 1-4\n";
  const Layout layout = read(by_groups).definition().layout;
  EXPECT_EQ(layout.pin[2], 0);
  EXPECT_EQ(layout.pin[1], 1);
  EXPECT_EQ(layout.pin[0], 2);
  EXPECT_EQ(layout.pin[3], 2);
  // A boxer's opposed cylinders stand at one place but on opposite throws, so they share no pin.
  const EngineFile boxer = read(std::string(kOneCylinder) +
                                "[layout]\ncylinders = 2\nfiring_angles_deg = 0,360\nbank_angles_deg = 90,-90\n"
                                "cylinder_positions_mm = 0,0\n");
  EXPECT_EQ(boxer.definition().layout.pin[1], 1);
  EXPECT_FALSE(boxer.section("layout").has("shared_pins"));
}

TEST_F(EngineFileTest, AnglesCountFromTheFirstCylinder) {
  const std::string two = std::string(kOneCylinder) + "[layout]\ncylinders = 2\n";
  EXPECT_NE(refusal(two + "firing_angles_deg = 30,390\n")
                .find("firing_angles_deg: cylinder 1 fires at 30 deg; all angles "
                      "count from its firing top dead centre"),
            std::string::npos);
  EXPECT_EQ(refusal(two + "firing_angles_deg = 0,360\n"), "");
  EXPECT_NE(
      refusal(std::string(kOneCylinder) + "[layout]\ncylinders = 4\nfiring_order = 4-2-1-3\n")
          .find("firing_order: begins with cylinder 4; all angles count from cylinder 1's firing top dead centre, so "
                "begin with it: 1-3-4-2"),
      std::string::npos);
}

TEST_F(EngineFileTest, PinsThatMeetAreNumberedByTheMiddleOfTheirRods) {
  // A four with two pins of two rods: cylinders 1 and 3 stand at one place, where the pins meet, and each pin goes on
  // to the other side.
  const std::string four =
      std::string(kOneCylinder) + "[layout]\ncylinders = 4\nfiring_angles_deg = 0,0,180,180\nshared_pins = 1-2,3-4\n";
  const auto pins = [&](const char* positions_mm) {
    const Layout layout = read(four + "cylinder_positions_mm = " + positions_mm + "\n").definition().layout;
    return std::vector<int>(layout.pin.begin(), layout.pin.begin() + 4);
  };
  EXPECT_EQ(pins("100,140,100,60"), (std::vector<int>{1, 1, 0, 0}));
  EXPECT_EQ(pins("100,60,100,140"), (std::vector<int>{0, 0, 1, 1}));
}

TEST_F(EngineFileTest, ThrowsMayBeGivenAsACheckWithFewDigits) {
  const std::string three = std::string(kOneCylinder) + "[layout]\ncylinders = 7\nfiring_order = 1-3-5-7-2-4-6\n";
  const EngineFile free = read(three);
  std::vector<std::string> rounded;
  for (const double angle_deg : free.section("layout").numbers("crank_throws_deg")) {
    rounded.push_back(shortest(static_cast<double>(static_cast<int>(angle_deg * 100)) / 100 + 30));
  }
  std::string list;
  for (const std::string& angle : rounded) list += (list.empty() ? "" : ",") + angle;
  expect_same(read(three + "crank_throws_deg = " + list + "\n").definition(), free.definition());
  EXPECT_NE(refusal(three + "crank_throws_deg = 0,0,0,0,0,0,0\n"), "");
  // Two digits behind the point are enough, one is not.
  const std::string two =
      std::string(kOneCylinder) + "[layout]\ncylinders = 2\nfiring_angles_deg = 0,600\ncrank_throws_deg = 0,";
  for (const char* good : {"120", "120.009", "119.991", "-240.009"}) EXPECT_EQ(refusal(two + good + "\n"), "") << good;
  for (const char* bad : {"120.011", "119.989", "120.1", "-240.1"}) EXPECT_NE(refusal(two + bad + "\n"), "") << bad;
}

TEST_F(EngineFileTest, ADiagramLiesBesideItsEngineFileAndOutlivesAMove) {
  write("pressure#1.csv", angle_table());
  EngineFile engine =
      read(std::string(kOneCylinder) + "[pressure]\nsource = angle_table\nfile = pressure#1.csv # rig\n");
  const EngineFile moved = std::move(engine);
  const Pressure& pressure = moved.definition().pressure;
  ASSERT_EQ(pressure.point_count, 360);
  EXPECT_EQ(pressure.points[0].at, -360);
  EXPECT_EQ(pressure.points[359].pressure_Pa, (100 + 358 % 7) * 1e3);
  // What is shown finds the diagram from any other folder.
  const std::string elsewhere = folder_ / "elsewhere";
  std::filesystem::create_directory(elsewhere);
  const std::string shown = show(moved);
  const EngineFile again = read_engine_file(write("elsewhere/complete.ini", shown), {});
  expect_same(again.definition(), moved.definition());
  EXPECT_EQ(show(again), shown);
}

TEST_F(EngineFileTest, ADiagramOverVolumeIsInCubicMetres) {
  std::string table = "volume_cm3,pressure_kPa\n";
  for (int i = 0; i < 40; ++i) table += "815.5,250\n";
  write("loop.csv", table);
  const EngineFile engine = read(std::string(kOneCylinder) + "[pressure]\nsource = volume_table\nfile = loop.csv\n");
  EXPECT_EQ(engine.definition().pressure.points[7].at, 815.5e-6);
  EXPECT_EQ(engine.definition().pressure.points[7].pressure_Pa, 250e3);
}

TEST_F(EngineFileTest, AnotherSourceLeavesItsRivalsKeysUnusedButChecked) {
  const std::string motored = replaced(contents(kSample), "source = wiebe", "source = none");
  const EngineFile engine = read(motored);
  EXPECT_EQ(engine.definition().pressure.source, PressureSource::none);
  EXPECT_FALSE(engine.section("pressure").has("intake_kPa"));
  EXPECT_NE(show(engine).find("intake_kPa = 98"), std::string::npos);  // kept for the day it is used again
  EXPECT_NE(refusal(replaced(motored, "intake_kPa = 98", "intake_kPa = -98")), "");
}

TEST_F(EngineFileTest, WhatATickCostsItsValvesIsShown) {
  const std::string single = contents(CRANKLOOP_SOURCE_DIR "/tools/engines/ohc_125.ini");
  // A fine step is at most 1 by the fastest rate; 512 are the most, and 2000 us the longest tick.
  const auto shown_of = [&](const std::string& text, double& rate) {
    const EngineFile engine = read(text);
    const TrainOfFile& train = engine.trains().front();
    rate = valve_reference::SingleMass(train.definition.valve, train.definition.rocker, 8.5e-3).fastest();
    const std::string line = "# a valve of train intake takes " +
                             std::to_string(static_cast<int>(std::ceil(100e-6 * rate))) +
                             " fine steps in the worst tick of 100 us and keeps its class of 0.1 um up to ";
    const std::string shown = show(engine);
    const std::size_t at = shown.find(line);
    EXPECT_NE(at, std::string::npos) << line;
    if (at == std::string::npos) return std::string();
    const std::string after = shown.substr(at + line.size());
    // A cubic follows some two degrees of this cam to 0.1 um, in each fine step.
    EXPECT_NEAR(std::stod(after) * 300e-6, 2 * std::ceil(100e-6 * rate), 0.1 * std::ceil(100e-6 * rate)) << after;
    return after.substr(after.find("rpm; ") + 5);
  };
  double rate = 0;
  EXPECT_EQ(shown_of(single, rate).find("no tick is too long for it\n"), 0u);
  EXPECT_LT(2e-3 * rate, 512);
  const std::string stiff = shown_of(replaced(single, "seat_N_per_mm = 100000", "seat_N_per_mm = 1e8"), rate);
  EXPECT_GT(2e-3 * rate, 512);
  const std::string most = "512 is the most, in a tick of ";
  ASSERT_EQ(stiff.find(most), 0u) << stiff.substr(0, 100);
  EXPECT_NEAR(std::stod(stiff.substr(most.size())), 512 / rate * 1e6, 0.01 * 512 / rate * 1e6)
      << "the lever's mean is that of another lift";
  EXPECT_EQ(show(read(contents(kSample))).find("fine steps") != std::string::npos,
            !read(contents(kSample)).trains().empty());
}

TEST_F(EngineFileTest, WhatTheLibraryRefusesIsToldAtTheLineOfTheKey) {
  const EngineFile engine = read(kOneCylinder);
  const std::string path = folder_ / "engine.ini";
  EXPECT_EQ(engine.explain({Reason::not_positive, -1, "crank.bore_m"}).what(),
            path + ":5: bore_mm: 95 must be greater than zero");
  // A key that stands at its default has no line of its own: the section's header is to blame.
  EXPECT_EQ(engine.explain({Reason::no_solution, -1, "crank.pin_offset_m"}).what(),
            path + ":4: pin_offset_mm: 0 cannot be met");
}

TEST_F(EngineFileTest, TheSpeedThatAnEngineCanHaveLimitsItsTicksButNotALoneValve) {
  const EngineFile engine = read_engine_file(CRANKLOOP_SOURCE_DIR "/tools/engines/ohc_125.ini", {"engine", "crank"});
  EXPECT_NEAR(engine.definition().crank.max_speed_rad_s, 500 * support::kPi, 1e-9);  // 15 000 rpm
  EXPECT_EQ(LoneValve(engine, "intake").definition().crank.max_speed_rad_s, 0);
  const std::string text = contents(CRANKLOOP_SOURCE_DIR "/tools/engines/ohc_125.ini");
  EXPECT_NE(refusal(replaced(text, "max_rpm = 15000", "max_rpm = 1500")).find("max_rpm: must not be less than rated"),
            std::string::npos);
}

TEST_F(EngineFileTest, FrictionLoadAndStarterAreReadInTheirUnitsOrAbsent) {
  const std::string crank = "[crank]\nbore_mm = 95\nstroke_mm = 115\nrod_length_mm = 210\ncompression_ratio = 19\n";
  const EngineFile without = read(crank);
  EXPECT_EQ(without.definition().friction.constant_Pa, 0);
  EXPECT_EQ(without.definition().machine.quadratic_Nm_s2, 0);
  EXPECT_EQ(without.definition().starter.stall_Nm, 0);
  EXPECT_EQ(show(read(show(without))), show(without));

  const std::string brakes =
      crank +
      "[friction]\nconstant_kPa = 90\nlinear_kPa_per_1000rpm = 26\nquadratic_kPa_per_1000rpm2 = 5\n"
      "[machine]\nlinear_Nm_per_1000rpm = 3\nquadratic_Nm_per_1000rpm2 = 42\ninertia_kg_m2 = 0.1\n"
      "[starter]\nstall_Nm = 420\nno_load_rpm = 380\n";
  const EngineFile engine = read(brakes);
  const EngineDefinition& d = engine.definition();
  constexpr double kSpeed_rad_s = 2000 * support::kPi / 30;  // at 2000 rpm
  EXPECT_NEAR(
      d.friction.constant_Pa + kSpeed_rad_s * (d.friction.linear_Pa_s + kSpeed_rad_s * d.friction.quadratic_Pa_s2),
      162e3, 1e-6);
  EXPECT_NEAR(d.machine.constant_Nm + kSpeed_rad_s * (d.machine.linear_Nm_s + kSpeed_rad_s * d.machine.quadratic_Nm_s2),
              174, 1e-9);
  EXPECT_EQ(d.machine.inertia_kg_m2, 0.1);
  EXPECT_EQ(d.starter.stall_Nm, 420);
  EXPECT_NEAR(d.starter.no_load_rad_s, 380 * support::kPi / 30, 1e-12);
  EXPECT_EQ(show(read(show(engine))), show(engine));

  EXPECT_NE(refusal(replaced(brakes, "constant_kPa = 90", "constant_kPa = -90")).find("constant_kPa"),
            std::string::npos);
  EXPECT_NE(refusal(replaced(brakes, "no_load_rpm = 380", "")).find("no_load_rpm: 0 must be greater than zero"),
            std::string::npos);
  EXPECT_NE(refusal("[friction]\nconstant_kPa = 90\n").find("needs a [crank] section"), std::string::npos);
}

TEST_F(EngineFileTest, ValveTrainSectionsAreReadCheckedAndShown) {
  const std::string train =
      "[cam intake]\nsource = polynomial\nmax_lift_mm = 6.301099\nhalf_angle_deg = 74\nexponents = 2,10,18,26\n"
      "full_lift_at_crank_deg = 470\n"
      "[rocker intake]\npivot_to_pad_mm = 39.61\npivot_to_cam_mm = 30.28\nbase_circle_mm = 12.5\npad_radius_mm = 30\n"
      "pivot_to_screw_mm = 33.28\nscrew_ball_mm = 10\nstem_above_pivot_mm = 1.65\nclearance_mm = 0.05\n"
      "cam_turns = toward_pivot\n"
      "[rocker exhaust-2]\nratio = 1\nbase_circle_mm = 15\nclearance_mm = 0.1\n"
      "[valve intake]\nper_cylinder = 1\nvalve_g = 33\nspring_g = 60\nrocker_inertia_kg_mm2 = 8.12\nspring_N_per_mm = "
      "40\n"
      "spring_preload_N = 205.8\ntrain_N_per_mm = 11765\ntrain_damping_ratio = 0.10\nguide_damping_ratio = 0.003\n"
      "seat_N_per_mm = 100000\nseat_damping_ratio = 0.10\n";
  const EngineFile engine = read(train);  // a valve train alone: no [engine], no [crank]
  EXPECT_EQ(engine.section("cam intake").number("phase_rate_deg_per_s"), 0);
  EXPECT_EQ(engine.section("valve intake").si("train_N_per_mm"), 11765e3);
  EXPECT_EQ(engine.section("valve intake").si("head_area_mm2"), 0);
  EXPECT_EQ(engine.section("rocker intake").text("cam_turns"), "toward_pivot");
  EXPECT_FALSE(engine.has("crank"));
  const std::string shown = show(engine);
  EXPECT_EQ(show(read(shown)), shown);
  EXPECT_NE(refusal(train + "ratio = 1\n"), "");
  EXPECT_NE(refusal(replaced(train, "train_N_per_mm = 11765", "train_N_per_mm = -1")).find("at most 1e9 N/mm"),
            std::string::npos);
  EXPECT_NE(refusal(replaced(train, "ratio = 1\n", "ratio = 1\ncam_turns = toward_pivot\n")), "");
  EXPECT_NE(refusal(replaced(train, "2,10,18,26", "2,18,10,26")), "");
}

TEST(EngineFileKeys, EveryKeySaysItsUnitAndHasAPossibleDefault) {
  for (const SectionKind& kind : section_kinds()) {
    for (const Key* key : keys_of(kind.name)) {
      SCOPED_TRACE(key->name);
      EXPECT_EQ(find_key(kind.name, key->name), key) << "named twice";
      const std::string name = key->name;
      const std::string unit = key->unit.name;
      if (!unit.empty()) {
        EXPECT_EQ(name.substr(name.size() - unit.size() - 1), "_" + unit);
      }
      EXPECT_TRUE(key->unit.times == 1 || key->unit.over == 1);
      EXPECT_NE(*key->meaning, '\0');
      if (key->presence == Presence::with_default) {
        EXPECT_EQ(format_value(parse_value(*key, key->fallback, "table", 1)), key->fallback);
      }
      EXPECT_NE(describe_all_keys().find("\n  " + name + " "), std::string::npos);
    }
  }
}

TEST(EngineFileKeys, WhatIsWrittenReadsBackBitForBit) {
  const std::uint64_t seed = 495;
  std::mt19937_64 random(seed);
  SCOPED_TRACE(seed);
  Key key = *find_key("crank", "bore_mm");
  key.range = Range{};
  for (int i = 0; i < 100'000; ++i) {
    const std::uint64_t bits = random();
    double number = 0;
    static_assert(sizeof number == sizeof bits);
    std::memcpy(&number, &bits, sizeof number);
    if (!std::isnormal(number)) continue;
    Value value;
    value.key = &key;
    value.numbers = {number};
    ASSERT_EQ(parse_value(key, format_value(value), "table", 1).numbers[0], number) << format_value(value);
  }
}

// ---- misfires -------------------------------------------------------------------------------------------------------

TEST_F(EngineFileTest, MisfiresHaveARuleForEachCylinder) {
  const std::string sample = contents(kSample);
  const EngineFile engine =
      read(sample +
           "[misfire 1]\nevery = 16\n[misfire 2]\nmisses = 3\nof_cycles = 10\n"
           "burning_ratio = 0.25\n[misfire 3]\nburst = 2\ngap = 5\n[misfire 4]\nrandom_ratio = 0.02\nseed = 7\n");
  const Misfire* rules = engine.definition().misfires;
  EXPECT_TRUE(engine.misfires());
  EXPECT_EQ(rules[0].pattern, MisfirePattern::spread);
  EXPECT_EQ(rules[0].misfires, 1);
  EXPECT_EQ(rules[0].of, 16);
  EXPECT_EQ(rules[1].pattern, MisfirePattern::spread);
  EXPECT_EQ(rules[1].misfires, 3);
  EXPECT_EQ(rules[1].of, 10);
  EXPECT_EQ(rules[1].burning_ratio, 0.25);
  EXPECT_EQ(rules[2].pattern, MisfirePattern::burst);
  EXPECT_EQ(rules[2].misfires, 2);
  EXPECT_EQ(rules[2].of, 7);
  EXPECT_EQ(rules[3].pattern, MisfirePattern::random);
  EXPECT_EQ(rules[3].random_ratio, 0.02);
  EXPECT_EQ(rules[3].seed, 7);
}

TEST_F(EngineFileTest, MisfiresOfACommandLineReplaceThoseOfTheFile) {
  EngineFile engine = read(contents(kSample) + "[misfire 2]\nevery = 16\n");
  engine.set_misfires({"cylinder=2 cycles=3,5,8", " cylinder=4  every=2"});
  const Misfire* rules = engine.definition().misfires;
  EXPECT_EQ(rules[1].pattern, MisfirePattern::listed);
  EXPECT_EQ(std::vector<int>(rules[1].cycles, rules[1].cycles + rules[1].cycle_count), (std::vector<int>{3, 5, 8}));
  EXPECT_EQ(rules[3].of, 2);
}

TEST_F(EngineFileTest, ACylinderHasOneMisfireRule) {
  const auto says = [this](const std::vector<std::string>& orders, const std::string& words) {
    EngineFile engine = read(contents(kSample));
    try {
      engine.set_misfires(orders);
      ADD_FAILURE() << words;
    } catch (const UsageError& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  };
  says({"cylinder=2 every=16", "cylinder=2 every=3"}, "--misfire: cylinder 2 has two rules; give it one");
  says({"cylinder=2 every=16 cylinder=3"}, "cylinder is given twice; each cylinder has its own rule");
  says({"cylinder=2 every=0"}, "--misfire 'cylinder=2 every=0': every: 0 is out of range");
  says({"cylinder=2"}, "--misfire 'cylinder=2': [misfire 2] needs either every, or ");
  says({"cylinder=2", "every=16"}, "--misfire 'every=16': lacks cylinder=N; write a rule in quotes, like ");
  const std::string text = refusal(contents(kSample) + "[misfire 2]\nevery = 2\n[misfire 02]\nevery = 3\n");
  EXPECT_NE(text.find("[misfire 02]: this cylinder has a rule already"), std::string::npos) << text;
}

TEST_F(EngineFileTest, MisfiresAreRefusedWithWhatIsAllowed) {
  const auto says = [this](const std::string& section, const std::string& words) {
    const std::string text = refusal(contents(kSample) + section);
    EXPECT_NE(text.find(words), std::string::npos) << section << text;
  };
  says("[misfire 5]\nevery = 2\n", "'5' is no cylinder; allowed: whole numbers from 1 to 4");
  says("[misfire one]\nevery = 2\n", "'one' is no cylinder");
  says("[misfire 1]\n", "needs either every, or misses and of_cycles, or random_ratio, or burst and gap, or cycles");
  says("[misfire 1]\nburst = 2\ngap = 3\nevery = 2\n", "give either burst and gap, or every");
  says("[misfire 1]\nmisses = 3\nof_cycles = 2\n", "misses: 3 of 2 cycles cannot misfire");
  says("[misfire 1]\nburst = 40000\ngap = 40000\n", "gap: burst and gap are more than 65535 cycles together");
  says("[misfire 1]\ncycles = 4,4\n", "cycles: 4 follows 4; they must rise");
  says("[misfire 1]\ncycles = 1.5\n", "cycles: 1.5 is not a whole number");
  std::string many = "1";
  for (int i = 2; i <= 33; ++i) many += "," + std::to_string(i);
  says("[misfire 1]\ncycles = " + many + "\n", "cycles: 33 given; allowed: up to 32");
}

// ---- faults of trigger wheels ---------------------------------------------------------------------------------------

TEST_F(EngineFileTest, FaultsOfWheelsHaveAllTheirKeys) {
  const EngineFile engine =
      read(contents(kSample) +
           "[fault worn]\ntrigger = cam\nstart_s = 1\nend_s = 2.5\nlate_deg = 8\n"
           "[fault wire]\ntrigger = crank\ninput_bit = 3\nmissing_tooth = 7\nmoved_tooth = 9\n"
           "moved_deg = -0.5\nrunout_deg = 0.3\nrunout_at_deg = 90\ninverted = yes\nstuck = high\n"
           "noise_Hz = 50\nnoise_pulse_us = 12\nnoise_seed = 5\nextra_tooth_deg = 349\nextra_width_deg = 1\n");
  ASSERT_EQ(engine.definition().wheel_fault_count, 2);
  const WheelFault &worn = engine.definition().wheel_faults[0], &wire = engine.definition().wheel_faults[1];
  EXPECT_EQ(worn.wheel, 1);
  EXPECT_EQ(worn.start_s, 1);
  EXPECT_EQ(worn.end_s, 2.5);
  EXPECT_EQ(worn.late_deg, 8);
  EXPECT_EQ(worn.input_bit, -1);
  EXPECT_EQ(wire.wheel, 0);
  EXPECT_EQ(wire.input_bit, 3);
  EXPECT_EQ(wire.missing_tooth, 7);
  EXPECT_EQ(wire.moved_tooth, 9);
  EXPECT_EQ(wire.moved_deg, -0.5);
  EXPECT_EQ(wire.extra_tooth_deg, 349);
  EXPECT_EQ(wire.extra_width_deg, 1);
  EXPECT_EQ(wire.runout_deg, 0.3);
  EXPECT_EQ(wire.runout_at_deg, 90);
  EXPECT_TRUE(wire.inverted);
  EXPECT_EQ(wire.stuck, StuckSignal::high);
  EXPECT_EQ(wire.noise_Hz, 50);
  EXPECT_EQ(wire.noise_pulse_s, 12e-6);
  EXPECT_EQ(wire.noise_seed, 5);
}

TEST_F(EngineFileTest, FaultsOfWheelsAreRefusedWithWhatIsAllowed) {
  const auto says = [this](const std::string& section, const std::string& words) {
    const std::string text = refusal(contents(kSample) + "[fault a]\n" + section);
    EXPECT_NE(text.find(words), std::string::npos) << section << text;
  };
  says("trigger = crnk\nend_s = 1\n", "trigger: 'crnk' is not one of crank, cam; did you mean crank?");
  says("trigger = crank\n", "end_s: 0 is never on: give end_s above start_s, or an input_bit");
  says("trigger = crank\nend_s = 1\nmissing_tooth = 3\nmoved_tooth = 3\n",
       "moved_tooth: 3 is the tooth that is missing");
  says("trigger = crank\nend_s = 1\nnoise_Hz = 3\n", "noise_pulse_us: 0 must be greater than zero");
  says("trigger = crank\nend_s = 1\nstuck = up\n", "stuck: 'up' is not one of no, low, high");
  // What only the wheel and the tick tell, as tabulate refuses it.
  const EngineFile engine = read(contents(kSample) + "[fault a]\ntrigger = crank\nend_s = 1\nmissing_tooth = 60\n");
  const std::string told = engine.explain(crankloop::refuse("fault.missing_tooth", Reason::out_of_range, 0)).what();
  EXPECT_NE(told.find("[fault a] missing_tooth: 60 is more than the wheel has teeth"), std::string::npos) << told;
}

TEST_F(EngineFileTest, ASensorHasAllItsKeysAndIsRefusedAtAWheelThatItDoesNotFit) {
  EXPECT_EQ(read(contents(kSample)).definition().reluctor.wheel, -1);
  const EngineFile engine =
      read(contents(kSample) +
           "[reluctor]\ntrigger = crank\ngain_V_s = 0.02\nreach_ratio = 0.8\n"
           "gap_lobe_ratio = 1.6\nrunout_ratio = 0.1\nrunout_at_deg = 30\nreversed = yes\n"
           "arm_ratio = 0.5\nleast_V = 0.1\nhysteresis_V = 0.02\nwatchdog_s = 0.2\ndelay_us = 12\n");
  const Reluctor& sensor = engine.definition().reluctor;
  EXPECT_TRUE(sensor.wheel == 0 && sensor.reversed);
  EXPECT_TRUE(sensor.gain_V_s == 0.02 && sensor.reach_ratio == 0.8 && sensor.gap_lobe_ratio == 1.6);
  EXPECT_TRUE(sensor.runout_ratio == 0.1 && sensor.runout_at_deg == 30 && sensor.arm_ratio == 0.5);
  EXPECT_TRUE(sensor.least_V == 0.1 && sensor.hysteresis_V == 0.02 && sensor.watchdog_s == 0.2 &&
              sensor.delay_s == 12 / 1e6);
  const std::string late = engine.explain(crankloop::refuse("reluctor.delay_s", Reason::out_of_range)).what();
  EXPECT_NE(late.find("delay_us: 12 is more than a tick"), std::string::npos) << late;
  const auto says = [this](const std::string& keys, const std::string& words) {
    const std::string text = refusal(contents(kSample) + "[reluctor]\n" + keys);
    EXPECT_NE(text.find(words), std::string::npos) << keys << text;
  };
  says("trigger = crnk\ngain_V_s = 1\n", "trigger: 'crnk' is not one of crank, cam; did you mean crank?");
  says("trigger = cam\ngain_V_s = 1\n", "trigger: 'cam' is no wheel of up to 120 evenly spaced teeth that no phaser");
  says("trigger = crank\n", "gain_V_s");
  says("trigger = crank\ngain_V_s = 1\nreach_ratio = 1.1\n", "reach_ratio: 1.1 is out of range; allowed: 0.6 to 1");
}

TEST_F(EngineFileTest, SensorFaultsHaveAllTheirKeysAndAreRefusedWithWhatIsWrong) {
  const std::string breathes = contents(std::string(CRANKLOOP_SOURCE_DIR) + "/tools/engines/four_2000.ini");
  const EngineFile engine =
      read(breathes +
           "[sensor_fault a]\nsensor = coolant\nstart_s = 1\nend_s = 2\nwire = short\n"
           "offset = -3\nnoise = 0.5\nnoise_seed = 9\ndelay_s = 0.1\nlag_s = 2\n"
           "least = 233\nmost = 423\nstep = 0.5\n[sensor_fault b]\nsensor = tps\ninput_bit = 3\n");
  ASSERT_EQ(engine.definition().sensor_fault_count, 2);
  const SensorFault &a = engine.definition().sensor_faults[0], &b = engine.definition().sensor_faults[1];
  EXPECT_TRUE(a.sensor == ControllerSensor::coolant && a.wire == SensorWire::shorted && a.input_bit == -1);
  EXPECT_TRUE(a.start_s == 1 && a.end_s == 2 && a.offset == -3 && a.noise == 0.5 && a.noise_seed == 9);
  EXPECT_TRUE(a.delay_s == 0.1 && a.lag_s == 2 && a.least == 233 && a.most == 423 && a.step == 0.5);
  EXPECT_TRUE(b.sensor == ControllerSensor::tps && b.wire == SensorWire::good && b.input_bit == 3);
  const auto says = [&](const std::string& keys, const std::string& words) {
    const std::string text = refusal(breathes + "[sensor_fault a]\n" + keys);
    EXPECT_NE(text.find(words), std::string::npos) << keys << text;
  };
  says("sensor = map\n", "[sensor_fault a] end_s: 0 is never on: give end_s above start_s, or an input_bit");
  says("sensor = map\nend_s = 1\nwire = open\n", "[sensor_fault a] most: 0 is not above least");
  says("sensor = map\nend_s = 1\nmost = 1e5\nstep = 1\n", "[sensor_fault a] step: 1 makes more than 65536 steps");
  says("sensor = oil\nend_s = 1\n", "'oil' is not one of map, intake_air");
  says("sensor = lambda\nend_s = 1\n", "[sensor_fault a] sensor: lambda needs a [lambda_sensor]");
  EXPECT_NE(
      refusal(contents(kSample) + "[sensor_fault a]\nsensor = map\nend_s = 1\n").find("needs [pressure] source = gas"),
      std::string::npos);
}

TEST_F(EngineFileTest, WhatACommandAtConstantSpeedLeavesOutIsTold) {
  const EngineFile engine = read(contents(std::string(CRANKLOOP_SOURCE_DIR) + "/tools/engines/four_2000.ini") +
                                 "[misfire 1]\nevery = 2\n[fault a]\ntrigger = crank\nend_s = 1\nlate_deg = 1\n"
                                 "[sensor_fault b]\nsensor = map\nend_s = 1\noffset = 1\n");
  const std::vector<std::string> told = warnings_about_misfires_left_out(engine);
  ASSERT_EQ(told.size(), 3u);
  EXPECT_NE(told[0].find("warning: [misfire 1]: every cycle fires in this command;"), std::string::npos) << told[0];
  EXPECT_NE(told[1].find("warning: [fault a]: every signal is healthy in this command;"), std::string::npos) << told[1];
  EXPECT_NE(told[2].find("warning: [sensor_fault b]: no sensor is read in this command;"), std::string::npos)
      << told[2];
  EXPECT_EQ(warnings_about_sensor_faults_left_out(engine), std::vector<std::string>{told[2]}) << "of a free run";
}

TEST_F(EngineFileTest, ALambdaSensorNeedsAnEngineThatBreathes) {
  const std::string breathes = contents(std::string(CRANKLOOP_SOURCE_DIR) + "/tools/engines/four_2000.ini");
  EXPECT_FALSE(read(breathes).definition().lambda_sensor.in_use);
  const EngineFile usual = read(breathes + "[lambda_sensor]\n");
  EXPECT_TRUE(usual.definition().lambda_sensor.in_use);
  EXPECT_EQ(usual.definition().lambda_sensor.pipe_m3, LambdaSensor{}.pipe_m3);
  const EngineFile engine = read(breathes + "[lambda_sensor]\npipe_cm3 = 800\nlag_s = 0.1\n");
  EXPECT_EQ(engine.definition().lambda_sensor.pipe_m3, 800 / 1e6);
  EXPECT_EQ(engine.definition().lambda_sensor.lag_s, 0.1);
  EXPECT_NE(refusal(breathes + "[lambda_sensor]\nlag_s = -1\n").find("lag_s: -1 is out of range; allowed: 0 to 100"),
            std::string::npos);
  const std::string diagram = refusal(contents(kSample) + "[lambda_sensor]\n");
  EXPECT_NE(diagram.find("[lambda_sensor] needs [pressure] source = gas"), std::string::npos) << diagram;
}

// ---- trigger wheels -------------------------------------------------------------------------------------------------

/// Teeth and gaps as they stand around a wheel: x a tooth, - none.
std::string drawing(const TriggerWheel& wheel) {
  std::string places;
  for (int i = 0; i < wheel.gap_count; ++i) {
    places += std::string(static_cast<std::size_t>(wheel.gaps[i].teeth), 'x') +
              std::string(static_cast<std::size_t>(wheel.gaps[i].missing), '-');
  }
  return places + std::string(static_cast<std::size_t>(wheel.places) - places.size(), 'x');
}

TEST_F(EngineFileTest, ReadsTriggerWheelsByTheNamesOfTheirPatterns) {
  const auto read_wheel = [this](const std::string& pattern) {
    return drawing(read(std::string(kOneCylinder) + "[trigger a]\non = crank\npattern = " + pattern + "\n")
                       .definition()
                       .triggers[0]);
  };
  EXPECT_EQ(read_wheel("4"), "xxxx");
  EXPECT_EQ(read_wheel("12-3"), "xxxxxxxxx---");
  EXPECT_EQ(read_wheel("60-2"), std::string(58, 'x') + "--");
  EXPECT_EQ(read_wheel("36-2-2-2"), "xxxxxxxxxxxxx--xxxxxxxxxxxxxxxx--x--");
  EXPECT_EQ(read_wheel("36-2-2-2-H6"), "xxxxxxxxxxxxxxxxxxx--xxxxxxxxxx--x--");
  EXPECT_EQ(read_wheel("half-moon"), "x");
  EXPECT_EQ(read_wheel("3(1)2"), "xxx-xx");
  for (const char* none :
       {"0", "60-60", "60-", "-2", "60-2-1", "3(1", "3(0)", "(2)3", "3(1)2(", "1000", "half moon", "3 (1)"}) {
    const std::string message =
        refusal(std::string(kOneCylinder) + "[trigger a]\non = crank\npattern = " + none + "\n");
    EXPECT_NE(message.find(":11: pattern: '" + std::string(none) + "' is no wheel"), std::string::npos)
        << none << ": " << message;
  }
  EXPECT_NE(refusal(std::string(kOneCylinder) + "[trigger a]\non = crank\npattern = 361\n").find("is too fine"),
            std::string::npos);
  EXPECT_NE(
      refusal(std::string(kOneCylinder) + "[trigger a]\non = crank\npattern = 1(1)1(1)1(1)1(1)1(1)1(1)1(1)1(1)1(1)\n")
          .find("is too fine"),
      std::string::npos);
}

TEST_F(EngineFileTest, ReadsWhereATriggerWheelStandsAndWhatMovesIt) {
  const std::string sample = contents(kSample);
  const EngineFile engine =
      read(sample + "[trigger exhaust]\non = cam exhaust\nedges_deg = 700,730,800,900\ninverted = yes\n");
  ASSERT_EQ(engine.definition().trigger_count, 3);
  const TriggerWheel* wheels = engine.definition().triggers;
  EXPECT_EQ(wheels[0].shaft, TriggerShaft::crank);
  EXPECT_EQ(wheels[0].train, -1);
  EXPECT_EQ(wheels[0].first_tooth_deg, 246);
  EXPECT_EQ(wheels[0].tooth_ratio, 0.5);
  EXPECT_FALSE(wheels[0].inverted);
  EXPECT_EQ(wheels[1].shaft, TriggerShaft::cam);
  EXPECT_EQ(wheels[1].train, 0);
  EXPECT_EQ(wheels[1].first_tooth_deg, 540);
  EXPECT_EQ(wheels[2].train, 1);
  EXPECT_EQ(wheels[2].pattern, TriggerPattern::edges);
  ASSERT_EQ(wheels[2].edge_count, 4);
  EXPECT_EQ(wheels[2].edges_deg[3], 900);
  EXPECT_TRUE(wheels[2].inverted);
  ASSERT_EQ(engine.triggers().size(), 3u);
  EXPECT_EQ(engine.triggers()[2].name, "exhaust");

  EXPECT_NE(refusal(sample + "[trigger a]\non = cam outlet\npattern = 1\n")
                .find("'cam outlet' is not one of crank, cam, cam intake, cam exhaust"),
            std::string::npos);
  EXPECT_NE(refusal(sample + "[trigger a]\non = crank\nedges_deg = 10,300,380,390\n")
                .find("edges_deg: entry 3: 380 is out of range"),
            std::string::npos);
}

TEST(PressureInWords, SaysOfAMotoredEngineThatItHasNoFuel) {
  const EngineFile engine = read_engine_file(CRANKLOOP_SOURCE_DIR "/tools/engines/diesel_435_motored.ini", {});
  GasOrder order = gas_order(engine.definition().gas);
  EXPECT_NE(pressure_in_words(engine, 1, order).find("Throttle 1, no fuel. Not modelled"), std::string::npos);
  order.fuel_kg = 10e-6;
  EXPECT_NE(pressure_in_words(engine, 1, order).find("10 mg of fuel per cylinder and cycle, burning from"),
            std::string::npos);
}

TEST(RangeInWords, HasBoundsAsPeopleWriteThem) {
  EXPECT_EQ(describe(from(0).up_to(2147483647), ""), "0 to 2147483647");
  EXPECT_EQ(describe(above(0).up_to(1e9), "s"), "above 0, at most 1e9 s");
  EXPECT_EQ(describe(from(-0.5).up_to(1e-9), ""), "-0.5 to 1e-09");
}

}  // namespace
}  // namespace crankloop::program::engine_file_test
