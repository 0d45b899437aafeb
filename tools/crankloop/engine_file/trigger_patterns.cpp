// Wheels of production engines, from the tables of public decoders, edge by edge:
//   rusEFI, github.com/rusefi/rusefi firmware/controllers/trigger/decoders/trigger_*.cpp
//   Speeduino, github.com/noisymime/speeduino speeduino/decoders.cpp
//   Ardu-Stim, github.com/speeduino/Ardu-Stim ardustim/ardustim/wheel_defs.h, a generator of their signals
// Where they differ:
//   chrysler-ngc-4   Ardu-Stim's crank signal is rusEFI's inverted: wide tooth, 15 teeth, wide gap, 16 teeth. Its cam
//                    comes 11 deg earlier.
//   ford-st170       All have the cam's teeth at 0, 90, 270, 450, 630 deg. rusEFI assumes that they are 10 deg wide;
//                    Ardu-Stim has 29 to 34 deg.
//   gm-ls-24x        rusEFI, Speeduino and Ardu-Stim agree on all rising edges; rusEFI has narrow teeth of 5 deg too.
//   mazda-miata-nb   Crank: all agree. Cam: rusEFI's shape of the variable cam, which is measured. Speeduino only
//                    counts its teeth; Ardu-Stim has teeth of 10 deg at 0, 340, 360 deg, an older shape of rusEFI
//                    teeth of 20 deg at 0, 340, 380 deg.
//   mazda-miata-na   Ardu-Stim has the wide cam tooth 10 deg later, in steps of 5 deg.
//   mitsubishi-4b11  rusEFI's order was the other way round until its pull request 4645 compared it with a running
//                    engine.
//   nissan-sr20-360  Windows of 8, 2, 2, 2 slots of 2 deg. Other Nissan discs have windows of other widths.
//   subaru-6-7       rusEFI's cam, which has the manual's angles since its pull request 2789. Ardu-Stim has the same
//                    groups, 3, 1, 2, 1, with teeth 6 deg apart instead of 15.
//
// The 36-2-2-2 wheel of Subaru, which others use too, has two gaps with a single tooth between them and one gap by
// itself. Teeth and gaps in the sense of rotation, from the first tooth after that pair: 13, gap, 16, gap, 1, gap on
// four-cylinder engines, and 19, gap, 10, gap, 1, gap on six-cylinder ones (all three sources). Cylinder 1 is at top
// dead centre at the fourth tooth after the single gap, and a cam tooth passes 45 deg before (VEMS).
#include "trigger_patterns.hpp"

#include <string_view>

#include "../files/words.hpp"

namespace crankloop::program {
namespace {

#define RUSEFI_DECODER(file) "github.com/rusefi/rusefi firmware/controllers/trigger/decoders/trigger_" file ".cpp"

constexpr std::array<WheelPair, kWheelPairs> kPairs{{
    {"bosch-quick-start", "60-2", "0+140 180+40 360+40 540+140", "Bosch's quick-start wheel on the cam",
     RUSEFI_DECODER("universal")},
    {"chrysler-ngc-4", "0+5x16/10 180+5x15/10 330+25", "0+36x3/72 216+144 396+36x3/72",
     "Chrysler, Dodge 4-cylinder NGC (36+2-2 and 7 teeth); cam 114 deg after crank", RUSEFI_DECODER("chrysler")},
    {"ford-st170", "36-1", "0+10 90+10x4/180", "Ford Focus ST170, SVT (5 cam teeth)",
     RUSEFI_DECODER("ford") ", wiki.speeduino.com decoders/ST170"},
    {"gm-ls-24x", "0+3 6+12x5/15 90+3 96+12x3/15 150+3x2/15 171+12x2/15 210+3x3/15 246+12 270+3 276+12 300+3x4/15",
     "0+360", "General Motors LS1, LS6 (24 coded teeth); cam 348 deg after crank",
     RUSEFI_DECODER("gm") ", speeduino.com/wiki/index.php/GM_24X"},
    {"honda-k", "0+4 20+4x12/30", "0+30x4/180 595+14", "Honda K series (12+1 and 4+1 teeth)", RUSEFI_DECODER("honda")},
    {"mazda-miata-na", "0+70x2/180", "0+72 360+143",
     "Mazda MX-5 NA, and like it Mitsubishi 4G63: one sensor disc; cam 164 deg after crank", RUSEFI_DECODER("mazda")},
    {"mazda-miata-nb", "0+4 70+4 180+4 250+4", "0+35 316+38 375+20", "Mazda MX-5 NB", RUSEFI_DECODER("mazda")},
    {"mitsubishi-4b11", "16(2)17(1)", "0+360", "Mitsubishi 4B11 (36-2-1 and half a moon)",
     RUSEFI_DECODER("mitsubishi") ", github.com/rusefi/rusefi/pull/4645"},
    {"nissan-sr20-360", "180", "0+16 192+4x3/180", "Nissan SR20, disc of 360 slots on the cam",
     RUSEFI_DECODER("nissan")},
    {"subaru-36-2-2-2", "13(2)16(2)1(2)", "0+10x2/180",
     "Subaru four-cylinder from 1999 (2 cam teeth, their width assumed); cam 135 deg after crank",
     "vems.hu/wiki InputTrigger/SubaruThirtySixMinusTwoMinusTwoMinusTwo"},
    {"subaru-6-7", "0+5 32+5 87+5 180+5 212+5 267+5", "0+5 165+5 330+5 345+5 360+5 525+5 705+5",
     "Subaru EJ to 1998 (6 crank and 7 cam teeth); cam 48 deg before crank", RUSEFI_DECODER("subaru")},
    {"toyota-2jz-vvti", "36-2", "0+3x3/240", "Toyota 2JZ-GE VVT-i (3 cam teeth); cam 96 deg after crank",
     RUSEFI_DECODER("toyota") ", thedeltaecho.wordpress.com/2010/03/14/2jz-ge-cam-crank-signals"},
}};

#undef RUSEFI_DECODER

/// Parser of a pattern's text.
class PatternText {
 public:
  explicit PatternText(std::string_view text) : rest_{text} {}

  [[nodiscard]] bool at_end() const { return rest_.empty(); }
  [[nodiscard]] bool skip(char c) {
    if (rest_.empty() || rest_[0] != c) return false;
    rest_.remove_prefix(1);
    return true;
  }
  /// Up to three digits; 0 where there are none, or more.
  [[nodiscard]] int number() {
    std::size_t digits = 0;
    while (digits < rest_.size() && rest_[digits] >= '0' && rest_[digits] <= '9') ++digits;
    int number = 0;
    for (std::size_t i = 0; i < digits && digits <= 3; ++i) number = 10 * number + (rest_[i] - '0');
    rest_.remove_prefix(digits);
    return number;
  }

 private:
  std::string_view rest_;
};

void add_gap(TriggerWheel& wheel, ToothGap gap) {
  if (wheel.gap_count < kMaxToothGaps) wheel.gaps[wheel.gap_count] = gap;
  ++wheel.gap_count;  // validate() refuses too many
  wheel.places += gap.teeth + gap.missing;
}

/// 60, 60-2. False for anything else.
bool read_nominal(std::string_view text, TriggerWheel& wheel) {
  PatternText pattern(text);
  const int places = pattern.number();
  int missing = 0;
  if (pattern.skip('-')) {
    missing = pattern.number();
    if (missing < 1 || missing >= places) return false;
  }
  if (places < 1 || !pattern.at_end()) return false;
  if (missing > 0) {
    add_gap(wheel, {places - missing, missing});
  } else {
    wheel.places = places;
  }
  return true;
}

/// 13(2)16(2)1(2), 5(1)6. False for anything else.
bool read_runs(std::string_view text, TriggerWheel& wheel) {
  PatternText pattern(text);
  while (!pattern.at_end()) {
    const int teeth = pattern.number();
    if (teeth < 1) return false;
    if (pattern.at_end()) {
      wheel.places += teeth;
      return wheel.gap_count > 0;
    }
    if (!pattern.skip('(')) return false;
    const int missing = pattern.number();
    if (missing < 1 || !pattern.skip(')')) return false;
    add_gap(wheel, {teeth, missing});
  }
  return wheel.gap_count > 0;
}

/// 0+5x16/10 180+25, as the table above has it.
std::vector<double> listed_edges_deg(std::string_view text) {
  std::vector<double> edges_deg;
  for (const std::string_view teeth : split(text, ' ')) {
    PatternText pattern(teeth);
    int rise_deg = pattern.number();
    const int width_deg = pattern.skip('+') ? pattern.number() : 0;
    const int count = pattern.skip('x') ? pattern.number() : 1;
    const int step_deg = pattern.skip('/') ? pattern.number() : 0;
    for (int i = 0; i < count; ++i, rise_deg += step_deg)
      edges_deg.insert(edges_deg.end(), {1.0 * rise_deg, 1.0 * rise_deg + width_deg});
  }
  return edges_deg;
}

}  // namespace

const std::array<WheelPair, kWheelPairs>& wheel_pairs() { return kPairs; }

bool read_pattern(const std::string& text, TriggerWheel& wheel, std::vector<double>& edges_deg) {
  for (const WheelPair& pair : kPairs) {
    if (text != pair.name) continue;
    const std::string shape = wheel.shaft == TriggerShaft::crank ? pair.crank : pair.cam;
    if (shape.find('+') == std::string::npos) return read_pattern(shape, wheel, edges_deg);
    edges_deg = listed_edges_deg(shape);
    return true;
  }
  if (text == "half-moon") return read_nominal("1", wheel);
  if (text == "36-2-2-2") return read_runs("13(2)16(2)1(2)", wheel);
  if (text == "36-2-2-2-H6") return read_runs("19(2)10(2)1(2)", wheel);
  return read_nominal(text, wheel) || read_runs(text, wheel);
}

std::string describe_patterns() {
  std::string text =
      "Trigger wheels: `pattern = ...` in a [trigger NAME] section is one of these.\n\n"
      "  60                 teeth, evenly spaced\n"
      "  60-2               of 60 places the last two are empty; first_tooth_deg is the tooth after the gap\n"
      "  13(2)16(2)1(2)     teeth and (missing) in turn\n"
      "  36-2-2-2           13(2)16(2)1(2), of four-cylinder engines; 36-2-2-2-H6: 19(2)10(2)1(2), of six\n"
      "  half-moon          one tooth, over half the turn where tooth_ratio is 0.5\n\n"
      "or the name of a pair in use, both for the wheel `on = crank` and for the one on a cam, each with its "
      "first_tooth_deg. A tooth is\n"
      "RISE+WIDTH in crank degrees after the first one's rising edge, RISE+WIDTHxCOUNT/STEP several alike. Widths are "
      "those of the signal that the\n"
      "source's decoder expects; sensors and their amplifiers may invert it (inverted = yes).\n";
  for (const WheelPair& pair : kPairs) {
    text += std::string("\n  ") + pair.name + "  " + pair.used_by + "\n    crank   " + pair.crank + "\n    cam     " +
            pair.cam + "\n    source  " + pair.source + "\n";
  }
  return text;
}

}  // namespace crankloop::program
