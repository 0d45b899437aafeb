// `crankloop stress`: random valve trains at random operating points, each refused for a reason or run within bounds.
#include <algorithm>
#include <string>

#include "../command_line/commands.hpp"
#include "../command_line/results.hpp"
#include "../command_line/shards.hpp"
#include "../command_line/summary.hpp"
#include "../files/error.hpp"
#include "../files/output_file.hpp"
#include "lab/stress/stress_tally.hpp"

namespace crankloop::program {
namespace {

StressKind kind_of(const Arguments& arguments) {
  return arguments.has("--smooth") ? StressKind::smooth : StressKind::any;
}

int run_one(const Arguments& arguments) {
  const int number = arguments.whole_number("--case");
  const StressCase drawn(static_cast<std::uint64_t>(arguments.whole_number("--seed")),
                         static_cast<std::uint64_t>(number), kind_of(arguments));
  StressTrials trials;
  const TrialResult result = trials.run(drawn, true);
  Summary s;
  s.line("case", drawn.text());
  s.line("verdict", name_of(result.verdict));
  if (!result.refusal.ok()) {
    s.line("reason", std::string(result.refusal.field) + " " + describe(result.refusal.reason));
  }
  if (!result.trouble.empty()) s.line("trouble", result.trouble);
  s.line("ticks", result.ticks);
  s.line("over_event_budget", result.over_budget ? "yes" : "no");
  s.line("landed", result.landed ? "yes" : "no");
  s.line("judged_again", result.judged_again ? "yes" : "no");
  s.line("error_of_class", result.of_class);
  s.line("error_of_allowed", result.of_allowed);
  print(s.text());
  return result.verdict == Verdict::refused || result.verdict == Verdict::ran ? kSuccess : kFailure;
}

/// Cases are computed in at most a thousand blocks.
struct Blocks {
  int cases;

  [[nodiscard]] int size() const noexcept { return std::max(1, cases / 1000); }
  [[nodiscard]] int count() const noexcept { return (cases + size() - 1) / size(); }
};

/// What a block of cases adds to the tally.
std::string run_block(const StressTally& asked, StressKind kind, int block) {
  const int size = Blocks{asked.cases}.size();
  StressTrials trials;
  StressTally tally;
  for (int number = block * size; number < std::min((block + 1) * size, asked.cases); ++number) {
    const StressCase drawn(static_cast<std::uint64_t>(asked.seed), static_cast<std::uint64_t>(number), kind);
    tally.add(number, drawn, trials.run(drawn, number % asked.compare_every == 0));
  }
  return tally.part();
}

int run_stress(const Arguments& arguments) {
  arguments.refuse_with("--case", {"--cases", "--reference-every", "--threads", "--shard", "--join", "--report"});
  if (arguments.has("--case")) return run_one(arguments);
  StressTally tally;
  tally.seed = arguments.whole_number("--seed");
  tally.cases = arguments.whole_number("--cases");
  tally.compare_every = arguments.whole_number("--reference-every");
  const std::string command_line = "crankloop stress --seed " + std::to_string(tally.seed) + " --cases " +
                                   std::to_string(tally.cases) + " --reference-every " +
                                   std::to_string(tally.compare_every) + (arguments.has("--smooth") ? " --smooth" : "");
  Results results(arguments, {"--report"});
  const Points points{"stress", "stressing", static_cast<std::size_t>(Blocks{tally.cases}.count()),
                      Identity().add(command_line)};
  const auto texts = results_of(arguments, points, {"--report"}, [&](std::size_t block) {
    return run_block(tally, kind_of(arguments), static_cast<int>(block));
  });
  if (!texts) return kSuccess;
  for (const std::string& text : *texts) tally.add_part(text);
  const std::vector<StabilityPoint> map = stability_map();
  if (Output* page = results["--report"]) page->write(report::to_html(stress_page(tally, map, command_line)));
  results.finish(text_of(tally, map));
  return tally.failures.empty() && worst_error(map) <= kLargestStabilityError ? kSuccess : kFailure;
}

constexpr Option kStressOptions[] = {
    whole_number("--seed", "N", from(0).up_to(2147483647), "seed of the random cases", "1"),
    whole_number("--cases", "N", from(1).up_to(100000000), "number of cases", "1000"),
    whole_number("--case", "N", from(0).up_to(100000000), "runs this case only and prints all details"),
    whole_number("--reference-every", "N", from(1).up_to(100000000),
                 "every Nth case is also compared with the converged reference, which takes most of the time", "10"),
    flag("--smooth", "only damped trains with smooth cams at speeds without float: the error of the steps alone"),
    kThreads,
    kShard,
    kPart,
    kJoin,
    text("--report", "F.html", "HTML file with the counts and the stability map; opens in any browser"),
};

}  // namespace

const Command kStress{"stress",
                      "random valve trains at random operating points: refused, or bounded and accurate",
                      "[--seed N] [--cases N] [--case N] [--reference-every N] [--smooth] [--threads N]\n"
                      "       [--report F.html] [--shard K/N --part F | --join F...]",
                      "crankloop stress --seed 7 --cases 2000 --report stress.html",
                      0,
                      kStressOptions,
                      run_stress,
                      true};

}  // namespace crankloop::program
