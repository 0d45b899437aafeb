// `crankloop stress`: random valve trains at random operating points, each refused for a reason or run within bounds.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "commands.hpp"
#include "error.hpp"
#include "output.hpp"
#include "progress.hpp"
#include "lab/stress/stress_tally.hpp"

namespace crankloop::program {
namespace {

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

constexpr double kLargestStabilityError = 0.01;  // of the theoretical limit

void write_tally(Output& out, const StressTally& tally, const std::vector<StabilityPoint>& map) {
  const auto count = [&](const std::string& name, double value) { write_summary(out, name, value, ""); };
  count("seed", tally.seed);
  count("cases", tally.cases);
  for (const auto& [reason, times] : tally.refused)
    out.write("refused = " + std::to_string(times) + "  # " + reason + "\n");
  count("ran", tally.ran);
  count("ran_all_cycles", tally.all_cycles);
  count("ticks", static_cast<double>(tally.ticks));
  count("over_event_budget", tally.over_budget);
  count("compared", tally.compared);
  count("judged_again", tally.judged_again);
  for (const double part : {0.5, 0.9, 0.99, 1.0}) {
    const std::string percent = std::to_string(static_cast<int>(std::lround(100 * part)));
    count("error_of_class_p" + percent, quantile(tally.of_class, part));
    count("error_of_allowed_p" + percent, quantile(tally.of_allowed, part));
  }
  if (!map.empty()) count("stability_limit_error", worst_error(map));
  count("diverged", tally.diverged);
  count("inaccurate", tally.inaccurate);
  count("refused_but_could_run", tally.wrongly_refused);
  for (const StressFailure& failure : tally.failures) {
    out.write("failure = --seed " + std::to_string(tally.seed) + " --case " + std::to_string(failure.number) + ": " +
              failure.what + "\n  # " + failure.drawn + "\n");
  }
}

int run_one(const Arguments& arguments) {
  const int number = arguments.whole_number("--case");
  const StressCase drawn(static_cast<std::uint64_t>(arguments.whole_number("--seed")),
                         static_cast<std::uint64_t>(number));
  StressTrials trials;
  const TrialResult result = trials.run(drawn, true);
  Output out = Output::standard();
  write_summary(out, "case", drawn.text());
  write_summary(out, "verdict", name_of(result.verdict));
  if (!result.refusal.ok()) {
    write_summary(out, "reason", std::string(result.refusal.field) + " " + describe(result.refusal.reason));
  }
  if (!result.trouble.empty()) write_summary(out, "trouble", result.trouble);
  write_summary(out, "ticks", static_cast<double>(result.ticks), "");
  write_summary(out, "over_event_budget", result.over_budget ? "yes" : "no");
  write_summary(out, "judged_again", result.judged_again ? "yes" : "no");
  write_summary(out, "error_of_class", result.of_class, "");
  write_summary(out, "error_of_allowed", result.of_allowed, "");
  out.finish();
  return result.verdict == Verdict::refused || result.verdict == Verdict::ran ? kSuccess : kFailure;
}

int run_stress(const Arguments& arguments) {
  if (arguments.has("--case")) return run_one(arguments);
  StressTally tally;
  tally.seed = arguments.whole_number("--seed");
  tally.cases = arguments.whole_number("--cases");
  tally.compare_every = arguments.whole_number("--reference-every");
  std::optional<Output> page;
  if (arguments.has("--report")) page.emplace(arguments.text("--report"));
  {
    StressTrials trials;
    Progress progress("stressing", tally.cases);
    for (int number = 0; number < tally.cases; ++number) {
      const StressCase drawn(static_cast<std::uint64_t>(tally.seed), static_cast<std::uint64_t>(number));
      tally.add(number, drawn, trials.run(drawn, number % tally.compare_every == 0));
      progress.long_step();
    }
  }
  const std::vector<StabilityPoint> map = stability_map();
  if (page) {
    const std::string command_line = "crankloop stress --seed " + std::to_string(tally.seed) + " --cases " +
                                     std::to_string(tally.cases) + " --reference-every " +
                                     std::to_string(tally.compare_every);
    page->write(report::to_html(stress_page(tally, map, command_line)));
    page->finish();
  }
  Output out = Output::standard();
  write_tally(out, tally, map);
  out.finish();
  return tally.failures.empty() && worst_error(map) <= kLargestStabilityError ? kSuccess : kFailure;
}

constexpr Option kOptions[] = {
    whole_number("--seed", "N", from(0).up_to(2147483647), "what the cases are drawn from", "1"),
    whole_number("--cases", "N", from(1).up_to(100000000), "how many", "1000"),
    whole_number("--case", "N", from(0).up_to(100000000), "only this one, with all that is told of it"),
    whole_number("--reference-every", "N", from(1).up_to(100000000),
                 "every Nth case is compared with the converged reference too, which costs most of the time", "10"),
    text("--report", "F.html", "file for the counts and the map of stability, which any browser shows"),
};

}  // namespace

const Command kStress{"stress",
                      "random valve trains at random operating points: refused, or bounded and accurate",
                      "[--seed N] [--cases N] [--case N] [--reference-every N] [--report F.html]",
                      "crankloop stress --seed 7 --cases 2000 --report stress.html",
                      0,
                      kOptions,
                      run_stress};

}  // namespace crankloop::program
