// build_layout(): firing angles, and the directions of the throws that follow from them.
#include <algorithm>
#include <cmath>

#include "../files/error.hpp"
#include "engine_file_parts.hpp"

namespace crankloop::program {
namespace {

/// Tolerance of a given throw, which may be rounded (102.86 for 720 / 7).
constexpr double kThrowToleranceDeg = 0.01;

void set_banks(SectionValues& values, const std::string& path, Layout& layout) {
  if (!values.has("bank_angles_deg")) {
    Value upright;
    upright.numbers.assign(static_cast<std::size_t>(layout.cylinders), 0.0);
    values.derive("bank_angles_deg", upright);
  }
  const std::vector<double>& banks_deg = one_per_cylinder(values, "bank_angles_deg", path);
  std::copy(banks_deg.begin(), banks_deg.end(), layout.bank_deg.begin());
}

void check_order(const SectionValues& values, const std::vector<int>& order, int cylinders, const std::string& path) {
  const auto wrong = [&](int cylinder, const char* how) {
    refuse(values, "firing_order",
           "cylinder " + std::to_string(cylinder) + how + "; every cylinder from 1 to " + std::to_string(cylinders) +
               " must be named once",
           path);
  };
  for (const int cylinder : order) {
    if (cylinder > cylinders) wrong(cylinder, " does not exist");
    if (std::count(order.begin(), order.end(), cylinder) > 1) wrong(cylinder, " fires twice");
  }
  for (int cylinder = 1; cylinder <= cylinders; ++cylinder) {
    if (std::count(order.begin(), order.end(), cylinder) == 0) wrong(cylinder, " does not fire");
  }
}

void set_firing(SectionValues& values, const std::string& path, Layout& layout) {
  if (values.has("firing_angles_deg")) {
    const std::vector<double>& angles_deg = one_per_cylinder(values, "firing_angles_deg", path);
    if (angles_deg[0] != 0) {
      refuse(values, "firing_angles_deg",
             "cylinder 1 fires at " + brief(angles_deg[0]) +
                 " deg; all angles count from its firing top dead centre, so subtract that from each (720 is 0)",
             path);
    }
    std::copy(angles_deg.begin(), angles_deg.end(), layout.firing_deg.begin());
    return;
  }
  if (!values.has("firing_order")) {
    if (layout.cylinders > 1) {
      throw InputError(path, values.line_of("cylinders"),
                       values.title() + " lacks firing_order (like 1-3-4-2) or firing_angles_deg; " +
                           cylinders_text(layout.cylinders) + " need one of them");
    }
    Value only_one;
    only_one.groups = {{1}};
    values.derive("firing_order", only_one);
  }
  const std::vector<int>& order = values.find("firing_order")->groups.at(0);
  check_order(values, order, layout.cylinders, path);
  if (order.front() != 1) {
    std::vector<int> from_1 = order;
    std::rotate(from_1.begin(), std::find(from_1.begin(), from_1.end(), 1), from_1.end());
    std::string words;
    for (const int cylinder : from_1) words += (words.empty() ? "" : "-") + std::to_string(cylinder);
    refuse(values, "firing_order",
           "begins with cylinder " + std::to_string(order.front()) +
               "; all angles count from cylinder 1's firing top dead centre, so begin with it: " + words,
           path);
  }
  const Status status = set_firing_order(order.data(), layout.cylinders, layout);
  if (!status.ok()) refuse(values, "firing_order", describe(status.reason), path);
}

/// A cylinder fires with its piston at the top, which determines the direction of its throw: given directions are only
/// checked.
void check_throws(SectionValues& values, const std::string& path, const Layout& layout) {
  if (!values.has("crank_throws_deg")) {
    Value throws;
    for (int k = 0; k < layout.cylinders; ++k) throws.numbers.push_back(full_turn(layout.throw_deg(k)));
    values.derive("crank_throws_deg", throws);
    return;
  }
  const std::vector<double>& given_deg = one_per_cylinder(values, "crank_throws_deg", path);
  for (int k = 1; k < layout.cylinders; ++k) {
    const double here_deg = full_turn(given_deg[static_cast<std::size_t>(k)] - given_deg[0]);
    const double needed_deg = full_turn(layout.throw_deg(k) - layout.throw_deg(0));
    if (apart_deg(here_deg, needed_deg) <= kThrowToleranceDeg) continue;
    refuse(values, "crank_throws_deg",
           "cylinder " + std::to_string(k + 1) + "'s throw is given " + brief(here_deg) +
               " deg from cylinder 1's; bank and firing angles put it at " + brief(needed_deg) +
               " deg (bank - firing, within " + shortest(kThrowToleranceDeg) + ")",
           path);
  }
}

}  // namespace

Layout build_layout(SectionValues& values, double bore_mm, const std::string& path) {
  Layout layout;
  fill(values, layout);
  set_banks(values, path, layout);
  set_firing(values, path, layout);
  check_throws(values, path, layout);
  place_cylinders(values, bore_mm, path, layout);
  return layout;
}

void refuse(const SectionValues& values, std::string_view key, const std::string& message, const std::string& path) {
  throw InputError(path, values.line_of(key), std::string(key) + ": " + message);
}

const std::vector<double>& one_per_cylinder(const SectionValues& values, std::string_view key,
                                            const std::string& path) {
  const int cylinders = static_cast<int>(values.number("cylinders"));
  const std::vector<double>& list = values.numbers(key);
  if (list.size() != static_cast<std::size_t>(cylinders)) {
    const std::string entries = std::to_string(list.size()) + (list.size() == 1 ? " entry" : " entries");
    refuse(values, key, entries + " for " + cylinders_text(cylinders) + "; one per cylinder is needed", path);
  }
  return list;
}

std::string cylinders_text(int count) { return std::to_string(count) + (count == 1 ? " cylinder" : " cylinders"); }

double full_turn(double angle_deg) {
  const double rest = std::fmod(angle_deg, 360.0);
  const double turned = rest < 0 ? rest + 360 : rest + 0.0;  // + 0.0: no negative zero
  return turned < 360 ? turned : 0;
}

double apart_deg(double a_deg, double b_deg) {
  const double difference = full_turn(a_deg - b_deg);
  return std::min(difference, 360 - difference);
}

}  // namespace crankloop::program
