#include "redline_vary.hpp"

#include <algorithm>

#include "../../command_line/variation.hpp"
#include "../../files/error.hpp"
#include "../../files/number.hpp"
#include "../../files/text_file.hpp"
#include "../../files/words.hpp"
#include "redline_search.hpp"

namespace crankloop::program {
namespace {

constexpr std::size_t kMaxTrains = 30;

/// The valve with a factor. Throws for a value outside the ranges of an engine file.
LoneValve varied_valve(const LoneValve& valve, const Influence& influence, double factor) {
  const Valve other = varied(valve.valve(), influence.option, factor);
  if (validate(other).ok()) return valve.with(other);
  throw InputError(valve.file().path() + ": " + brief(factor) + " times " + influence.keys + " of [valve " +
                   valve.train().name + "] is out of range");
}

void refuse_nothing_to_vary(const LoneValve& valve, const std::string& option) {
  const Valve& v = valve.valve();
  const bool nothing =
      (option == "spring" && v.spring_N_m == 0) ||
      (option == "damping" && v.train_damping_ratio == 0 && v.guide_damping_ratio == 0 && v.seat_damping_ratio == 0);
  if (nothing)
    throw InputError(valve.file().path() + ": [valve " + valve.train().name + "]: --vary " + option +
                     " has nothing to vary: it is 0");
}

const Influence& influence_of(const std::string& option) {
  std::vector<std::string> names;
  for (const Influence& influence : kInfluences) {
    if (option == influence.option) return influence;
    names.emplace_back(influence.option);
  }
  throw UsageError("--vary: " + in_quotes(option) + " is not one of " + join(names) + suggestion(option, names) +
                   "; or write SECTION.KEY=FROM:TO:N, like rocker.clearance_mm=0.02:0.1:5");
}

VariedTrains by_factors(const LoneValve& valve, const std::string& option) {
  const Influence& influence = influence_of(option);
  refuse_nothing_to_vary(valve, option);
  VariedTrains varied{option, influence.title, influence.keys, ""};
  for (const double factor : kInfluenceFactors)
    varied.trains.push_back(
        {std::make_shared<LoneValve>(varied_valve(valve, influence, factor)), factor, brief(factor), factor == 1});
  return varied;
}

std::string text_of_file(const std::string& path) {
  FileBytes file = read_file(path, kMaxEngineFileBytes);
  if (!file.ok()) throw InputError(path + ": " + file.problem);
  return std::move(file.bytes);
}

bool is_own(const Variation& variation, std::size_t i) {
  return variation.own_number ? variation.numbers[i] == *variation.own_number : variation.values[i] == variation.own;
}

/// Where it is not among the values, the train as given stands at its place among numbers, and before words.
void add_as_given(VariedTrains& varied, const Variation& variation, const LoneValve& valve) {
  auto& trains = varied.trains;
  if (std::any_of(trains.begin(), trains.end(), [](const VariedTrain& one) { return one.as_given; })) return;
  VariedTrain given{std::make_shared<LoneValve>(valve), variation.own_number.value_or(0),
                    variation.own.empty() ? "as given" : variation.own, true};
  const auto next = std::find_if(trains.begin(), trains.end(),
                                 [&](const VariedTrain& one) { return !variation.own_number || one.at > given.at; });
  trains.insert(next, std::move(given));
}

VariedTrains by_key(const LoneValve& valve, const std::string& option) {
  const Variation variation = parse_variation(option, valve.file(), {});
  if (variation.values.size() > kMaxTrains)
    throw UsageError("--vary: at most " + std::to_string(kMaxTrains) +
                     " values; `crankloop study` takes more, --of redline.separation_onset");
  const KeyPlace& place = *variation.target.key;
  VariedTrains varied{option, variation.target.title(), place.text(), variation.target.unit(),
                      false,  variation.is_of_words()};
  const std::string text = text_of_file(valve.file().path());
  for (std::size_t i = 0; i < variation.values.size(); ++i) {
    try {
      varied.files.push_back(read_engine_text(text, valve.file().path(), {}, {{place, variation.values[i]}}));
      require_used(varied.files.back(), place);
      const auto train = std::make_shared<LoneValve>(varied.files.back(), valve.train().name);
      const bool word = varied.are_words;
      varied.trains.push_back({train, word ? static_cast<double>(i + 1) : variation.numbers[i],
                               word ? variation.values[i] : brief(variation.numbers[i]), is_own(variation, i)});
    } catch (const InputError& refused) {
      throw InputError(std::string(refused.what()) + "\n" + valve.file().path() + ": refused with " + place.text() +
                       " = " + variation.values[i] + "; `crankloop study` leaves a gap there");
    }
  }
  add_as_given(varied, variation, valve);
  return varied;
}

}  // namespace

VariedTrains varied_trains(const LoneValve& valve, const std::string& option) {
  return option.find('=') == std::string::npos ? by_factors(valve, option) : by_key(valve, option);
}

}  // namespace crankloop::program
