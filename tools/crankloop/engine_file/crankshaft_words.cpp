#include "crankshaft_words.hpp"

#include <algorithm>
#include <numeric>

#include "../files/number.hpp"
#include "../files/words.hpp"
#include "engine_file_parts.hpp"

namespace crankloop::program {
namespace {

constexpr double kSameDeg = 1e-6;  ///< as in core: equal but for rounding

double bank_deg(const Layout& layout, int cylinder) { return layout.bank_deg[static_cast<std::size_t>(cylinder)]; }

bool at_an_angle(const Layout& layout, int a, int b) {
  const double apart = apart_deg(bank_deg(layout, a), bank_deg(layout, b));
  return apart > kSameDeg && apart < 180 - kSameDeg;  // opposed cylinders have a throw each
}

}  // namespace

std::vector<CrankThrow> throws_of(const Layout& layout) {
  std::vector<CrankThrow> throws;
  for (int k = 0; k < layout.cylinders; ++k) {
    const std::size_t pin = layout.pin[static_cast<std::size_t>(k)];
    if (throws.size() <= pin) throws.resize(pin + 1);
    throws[pin].direction_deg = full_turn(layout.throw_deg(k));
    throws[pin].cylinders.push_back(k + 1);
  }
  return throws;
}

std::vector<std::string> throws_in_words(const Layout& layout) {
  const std::vector<CrankThrow> throws = throws_of(layout);
  const auto count = [](std::size_t number, const char* what) {
    return std::to_string(number) + " " + what + (number == 1 ? "" : "s");
  };
  std::vector<std::string> lines{cylinders_text(layout.cylinders) + " on " + count(throws.size(), "crank throw") +
                                 ". At engine angle 0, from the vertical in the sense of rotation:"};
  for (std::size_t i = 0; i < throws.size(); ++i) {
    std::vector<std::string> rods;
    for (const int cylinder : throws[i].cylinders) {
      rods.push_back("cylinder " + std::to_string(cylinder) + " (bank " + brief(bank_deg(layout, cylinder - 1)) +
                     " deg)");
    }
    lines.push_back("throw " + std::to_string(i + 1) + " at " + brief(throws[i].direction_deg) + " deg: " + join(rods));
  }
  return lines;
}

std::string firing_in_words(const Layout& layout) {
  std::vector<int> order(static_cast<std::size_t>(layout.cylinders));
  std::iota(order.begin(), order.end(), 0);
  const auto at_deg = [&layout](int cylinder) { return layout.firing_deg[static_cast<std::size_t>(cylinder)]; };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return at_deg(a) < at_deg(b); });
  std::vector<std::string> cylinders;
  std::vector<std::string> angles;
  std::vector<std::string> intervals;
  for (std::size_t i = 0; i < order.size(); ++i) {
    cylinders.push_back(std::to_string(order[i] + 1));
    angles.push_back(brief(at_deg(order[i])));
    const bool last = i + 1 == order.size();
    intervals.push_back(brief((last ? at_deg(order[0]) + 720 : at_deg(order[i + 1])) - at_deg(order[i])));
  }
  return "Fires " + join(cylinders, "-") + ", at " + join(angles) + " deg: " + join(intervals) + " deg apart.";
}

std::vector<std::string> pairs_for_one_pin(const Layout& layout) {
  std::vector<std::string> pairs;
  for (int k = 0; k + 1 < layout.cylinders; ++k) {
    if (!at_an_angle(layout, k, k + 1)) continue;
    if (apart_deg(layout.throw_deg(k), layout.throw_deg(k + 1)) > kSameDeg) continue;
    pairs.push_back(std::to_string(k + 1) + "-" + std::to_string(k + 2));
    ++k;  // each rod runs on one pin
  }
  return pairs;
}

bool are_opposed(const Layout& layout) {
  for (int k = 0; k + 1 < layout.cylinders; ++k) {
    if (apart_deg(bank_deg(layout, k), bank_deg(layout, k + 1)) < 180 - kSameDeg) return false;
  }
  return layout.cylinders > 1;
}

std::string shared_pins_hint(const Layout& layout) {
  if (static_cast<int>(throws_of(layout).size()) < layout.cylinders) return "";
  int a = 0;  // of the first two neighbours with banks at an angle
  while (a + 1 < layout.cylinders && !at_an_angle(layout, a, a + 1)) ++a;
  if (a + 1 >= layout.cylinders) return "";
  const std::string start = "No two rods share a crank pin; where they do, name them: shared_pins = ";
  const std::vector<std::string> pairs = pairs_for_one_pin(layout);
  if (2 * static_cast<int>(pairs.size()) == layout.cylinders) return start + join(pairs, ",");
  if (!pairs.empty())
    return start + join(pairs, ",") +
           ". The bank - firing angles of the others differ: are the signs of the banks right?";
  return start + std::to_string(a + 1) + "-" + std::to_string(a + 2) +
         ". Their bank - firing angles must then be equal, and are " + brief(full_turn(layout.throw_deg(a))) + " and " +
         brief(full_turn(layout.throw_deg(a + 1))) + " deg.";
}

std::string crankshaft_comments(const Layout& layout) {
  if (layout.cylinders < 2) return "";
  std::string text;
  for (const std::string& line : throws_in_words(layout)) text += (text.empty() ? "# " : "#   ") + line + "\n";
  text += "# " + firing_in_words(layout) + "\n";
  const std::string hint = shared_pins_hint(layout);
  return hint.empty() ? text : text + "# " + hint + "\n";
}

}  // namespace crankloop::program
