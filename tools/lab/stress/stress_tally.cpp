#include "stress_tally.hpp"

#include <algorithm>
#include <cmath>

#include "crankloop/command_line/shards.hpp"
#include "crankloop/command_line/summary.hpp"
#include "crankloop/files/number.hpp"
#include "crankloop/files/words.hpp"
#include "stress_comparison.hpp"

namespace crankloop::program {
namespace {

using report::Paragraph;
using report::Plot;
using report::plot_of;
using report::Section;

report::Axis axis(const char* title) {
  report::Axis one;
  one.title = title;
  one.include_zero = true;
  return one;
}

Section stability_section(const std::vector<StabilityPoint>& map) {
  Section section{"stability", "Stability", {}};
  section.blocks.push_back(Paragraph{
      "The longest Runge-Kutta step at which the motion does not grow: frequency times step over the damping ratio. "
      "Measured: 2000 steps of the library. Theory: the amplification factor is 1. The library "
      "never takes a step longer than the lowest curve, which is that of the coarsest accuracy class."});
  Plot plot = plot_of("Limit of frequency times step", axis("Damping ratio"), axis("Frequency times step"));
  plot.series.resize(3);
  plot.series[0].name = "theory";
  plot.series[1].name = "measured";
  plot.series[1].style.draw = report::Draw::points;
  plot.series[2].name = "longest used";
  Plot ratio = plot_of("Measured limit over theory", axis("Damping ratio"), axis("Ratio"));
  ratio.y.include_zero = false;
  ratio.series.resize(1);
  for (const StabilityPoint& point : map) {
    const double limits[] = {point.theory, point.measured, point.used_most};
    for (std::size_t i = 0; i < 3; ++i) {
      plot.series[i].x.push_back(point.damping_ratio);
      plot.series[i].y.push_back(limits[i]);
    }
    ratio.series[0].x.push_back(point.damping_ratio);
    ratio.series[0].y.push_back(point.measured / point.theory);
  }
  section.blocks.push_back(std::move(plot));
  section.blocks.push_back(std::move(ratio));
  return section;
}

/// Distribution of the errors.
Section accuracy_section(const StressTally& tally) {
  Section section{"accuracy", "Accuracy", {}};
  section.blocks.push_back(Paragraph{
      "Largest error of the lift of each compared case, relative to the requested accuracy and to the permitted "
      "error. The permitted error is " +
      brief(kMagnified) +
      " times the sum of the accuracy and the largest deviation of copies of the reference, which are disturbed by " +
      "the accuracy at each contact change. A case that exceeds it with " + std::to_string(kCopies) +
      " copies is compared again with " + std::to_string(kMoreCopies) + ": " + std::to_string(tally.judged_again) +
      " times."});
  Plot plot = plot_of("Distribution of the errors", axis("Per cent of the comparisons"), axis("Relative error"));
  plot.y.include_zero = false;
  plot.y.logarithmic = true;
  plot.series.resize(3);
  plot.series[0].name = "to the requested accuracy";
  plot.series[1].name = "to the permitted error";
  plot.series[2].name = "to the requested accuracy, cases that landed";
  for (int percent = 1; percent <= 100; ++percent) {
    const double values[] = {quantile(tally.of_class, percent / 100.0), quantile(tally.of_allowed, percent / 100.0),
                             quantile(tally.of_class_landed, percent / 100.0)};
    for (std::size_t i = 0; i < 3; ++i) {
      plot.series[i].x.push_back(percent);
      plot.series[i].y.push_back(std::max(1e-6, values[i]));
    }
  }
  section.blocks.push_back(std::move(plot));
  return section;
}

Section counts_section(const StressTally& tally) {
  Section section{"counts", "Counts", {}};
  report::Table refused{"Refused at set-up", {{"Field and reason", "", false}, {"Cases", ""}}, {}, false};
  for (const auto& [reason, times] : tally.refused) refused.rows.push_back({reason, std::to_string(times)});
  section.blocks.push_back(std::move(refused));
  report::Table failures{"Failures", {{"Case", "", false}, {"What", "", false}, {"Drawn", "", false}}, {}, false};
  for (const StressFailure& one : tally.failures)
    failures.rows.push_back({std::to_string(one.number), one.what, one.drawn});
  if (!tally.failures.empty()) section.blocks.push_back(std::move(failures));
  return section;
}

constexpr int StressTally::*kCounters[] = {
    &StressTally::ran,       &StressTally::all_cycles,   &StressTally::over_budget,     &StressTally::compared,
    &StressTally::landed,    &StressTally::judged_again, &StressTally::wrongly_refused, &StressTally::diverged,
    &StressTally::inaccurate};

struct Errors {
  const char* name;
  std::vector<double> StressTally::*errors;
};
constexpr Errors kErrors[] = {{"of_class", &StressTally::of_class},
                              {"of_class_landed", &StressTally::of_class_landed},
                              {"of_allowed", &StressTally::of_allowed}};

}  // namespace

int beyond_class(const std::vector<double>& of_class) {
  return static_cast<int>(std::count_if(of_class.begin(), of_class.end(), [](double error) { return error > 1; }));
}

void StressTally::add(int number, const StressCase& drawn, const TrialResult& result) {
  const auto fail = [&](int& counter) {
    ++counter;
    failures.push_back({number, name_of(result.verdict) + (": " + result.trouble), drawn.text()});
  };
  switch (result.verdict) {
    case Verdict::refused:
      ++refused[std::string(result.refusal.field) + " " + describe(result.refusal.reason)];
      return;
    case Verdict::wrongly_refused:
      return fail(wrongly_refused);
    case Verdict::diverged:
      fail(diverged);
      break;
    case Verdict::inaccurate:
      fail(inaccurate);
      break;
    case Verdict::ran:
      break;
  }
  ++ran;
  ticks += result.ticks;
  all_cycles += result.all_cycles ? 1 : 0;
  over_budget += result.over_budget ? 1 : 0;
  if (!result.compared) return;
  ++compared;
  judged_again += result.judged_again ? 1 : 0;
  of_class.push_back(result.of_class);
  if (result.landed) {
    ++landed;
    of_class_landed.push_back(result.of_class);
  }
  if (!result.over_budget) of_allowed.push_back(result.of_allowed);
}

std::string StressTally::part() const {
  std::string text = "counts";
  for (const auto counter : kCounters) text += " " + std::to_string(this->*counter);
  text += "\tticks " + std::to_string(ticks);
  for (const auto& list : kErrors) {
    text += std::string("\t") + list.name;
    for (const double error : this->*list.errors) text += " " + exact_text(error);
  }
  for (const auto& [reason, times] : refused) text += "\trefused " + std::to_string(times) + " " + reason;
  for (const StressFailure& one : failures)
    text += "\tfailed " + std::to_string(one.number) + "\t" + one.what + "\t" + one.drawn;
  return text;
}

void StressTally::add_part(const std::string& text) {
  const auto fields = split(text, '\t');
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const auto words = split(fields[i], ' ');
    const auto number = [&words](std::size_t at) { return static_cast<std::int64_t>(exact_number(words.at(at))); };
    if (words[0] == "counts") {
      for (std::size_t c = 0; c < std::size(kCounters); ++c) this->*kCounters[c] += static_cast<int>(number(c + 1));
    } else if (words[0] == "ticks") {
      ticks += number(1);
    } else if (words[0] == "refused") {
      refused[std::string(fields[i].substr(fields[i].find(' ', words[0].size() + 1) + 1))] +=
          static_cast<int>(number(1));
    } else if (words[0] == "failed") {
      failures.push_back({static_cast<int>(number(1)), std::string(fields.at(i + 1)), std::string(fields.at(i + 2))});
      i += 2;
    }
    for (const auto& list : kErrors) {
      for (std::size_t w = 1; words[0] == list.name && w < words.size(); ++w)
        (this->*list.errors).push_back(exact_number(words[w]));
    }
  }
}

int StressTally::refusals() const {
  int sum = 0;
  for (const auto& [reason, times] : refused) sum += times;
  return sum;
}

double quantile(std::vector<double> values, double part) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const auto at = static_cast<std::size_t>(part * static_cast<double>(values.size() - 1));
  return values[at];
}

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::wrongly_refused:
      return "refused but could run";
    case Verdict::diverged:
      return "diverged";
    case Verdict::inaccurate:
      return "inaccurate";
    case Verdict::refused:
      return "refused";
    case Verdict::ran:
      break;
  }
  return "ran";
}

double worst_error(const std::vector<StabilityPoint>& map) {
  double worst = 0;
  for (const StabilityPoint& point : map) worst = std::max(worst, std::fabs(point.error()));
  return worst;
}

std::string text_of(const StressTally& tally, const std::vector<StabilityPoint>& map) {
  Summary s;
  s.line("seed", tally.seed);
  s.line("cases", tally.cases);
  for (const auto& [reason, times] : tally.refused) s.line("refused", times, "", reason);
  s.line("ran", tally.ran);
  s.line("ran_all_cycles", tally.all_cycles);
  s.line("ticks", tally.ticks);
  s.line("over_event_budget", tally.over_budget);
  s.line("compared", tally.compared);
  s.line("landed", tally.landed, "", "of those compared");
  s.line("judged_again", tally.judged_again);
  s.line("beyond_class", beyond_class(tally.of_class));
  s.line("beyond_class_landed", beyond_class(tally.of_class_landed));
  for (const double part : {0.5, 0.9, 0.99, 1.0}) {
    const std::string percent = std::to_string(static_cast<int>(std::lround(100 * part)));
    s.line("error_of_class_p" + percent, quantile(tally.of_class, part));
    s.line("error_of_class_landed_p" + percent, quantile(tally.of_class_landed, part));
    s.line("error_of_allowed_p" + percent, quantile(tally.of_allowed, part));
  }
  if (!map.empty()) s.line("stability_limit_error", worst_error(map));
  s.line("diverged", tally.diverged);
  s.line("inaccurate", tally.inaccurate);
  s.line("refused_but_could_run", tally.wrongly_refused);
  for (const StressFailure& failure : tally.failures) {
    s.line("failure",
           "--seed " + std::to_string(tally.seed) + " --case " + std::to_string(failure.number) + ": " + failure.what);
    s.text("  # " + failure.drawn + "\n");
  }
  return s.text();
}

report::Page stress_page(const StressTally& tally, const std::vector<StabilityPoint>& map,
                         const std::string& command_line) {
  report::Page page;
  page.title = "Stress test of elastic valves";
  page.subtitle = std::to_string(tally.cases) + " random valve trains and operating points: " + command_line;
  const auto fact = [&](const char* name, int value, const std::string& note) {
    page.facts.push_back({name, std::to_string(value), "", note});
  };
  fact("Refused", tally.refusals(), "at set-up, for a valid reason");
  fact("Ran", tally.ran,
       std::to_string(tally.all_cycles) + " through " + std::to_string(kStressCycles) + " cycles, the others for " +
           std::to_string(kStressTicks) + " ticks");
  fact("Compared", tally.compared, "with the converged reference; " + std::to_string(tally.landed) + " of them landed");
  fact("Diverged", tally.diverged, "");
  fact("Inaccurate", tally.inaccurate, "");
  fact("Refused but could run", tally.wrongly_refused, "");
  page.sections = {stability_section(map), accuracy_section(tally), counts_section(tally)};
  page.footer = "Made by " + command_line + ".";
  return page;
}

}  // namespace crankloop::program
