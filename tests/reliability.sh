#!/bin/sh
# reliability.sh [--long | --page]
# Writes docs/reliability.md: what was tried to break crankloop, and what came of it.
#
# Runs what has no log in build/reliability yet, so that a run of hours need not be repeated for another: delete a log
# to renew its figures. --long is for those hours: 100 000 random cases, 10^8 hostile inputs, 10^9 ticks of soak, 6
# minutes of each fuzz target, the whole suite under the sanitizers. Needs the presets release, check, sanitize and
# coverage (clang++, llvm-cov), and builds them; clang++-19 for its numerical sanitizer. --page runs nothing: the page
# from the logs there are.
set -eu
CDPATH='' cd -- "$(dirname -- "$0")/.."
logs=build/reliability
mkdir -p "$logs"

long=false
seeds='1 2'
cases=1000
fuzz_seconds=15
if [ "${1:-}" = --long ]; then
  long=true
  seeds='1 2 3 4 5 6 7 8 9 10'
  cases=10000
  fuzz_seconds=360
  export CRANKLOOP_LONG_TESTS=1
fi

build() { cmake --preset "$1" >"$logs/build.log" 2>&1 && cmake --build --preset "$@" >>"$logs/build.log" 2>&1; }

# keep NAME PRESET TARGET command...: runs the command unless its log is there; what fails shows in the page.
keep() {
  log=$logs/$1.log
  [ ! -s "$log" ] || return 0
  build "$2" --target "$3" || { echo "$2 does not build: $logs/build.log" >&2 && exit 1; }
  shift 3
  { printf '%s\n' "$*" && "$@"; } >"$log.part" 2>&1 || echo "failed: $*" >&2
  mv "$log.part" "$log"
}

if [ "${1:-}" != --page ]; then
  for seed in $seeds; do
    keep "stress-$seed" release crankloop_program build/release/bin/crankloop stress --seed "$seed" --cases "$cases"
  done
  keep faults check crankloop_property_tests build/check/tests/crankloop_property_tests --gtest_filter='FaultInjection*'
  keep soak check crankloop_property_tests build/check/tests/crankloop_property_tests --gtest_filter='Soak*'
  keep edges check crankloop_unit_tests build/check/tests/crankloop_unit_tests --gtest_filter='TableEdges*'
  keep fuzz sanitize fuzz_targets env CRANKLOOP_FUZZ_SECONDS="$fuzz_seconds" tools/check fuzz
  for log in build/check-logs/fuzz-*.log; do
    [ -e "$log" ] || continue
    case $log in *-configure.log | *-build.log) continue ;; esac
    [ -s "$logs/${log##*/}" ] || sed -n 's/^Done /Done /p' "$log" >"$logs/${log##*/}"
  done
  keep coverage coverage crankloop_program tests/coverage.sh
  keep threads thread crankloop_property_tests build/thread/tests/crankloop_property_tests --gtest_filter='Threads*'
  if command -v clang++-19 >/dev/null; then keep numerical release crankloop tests/numerical_sanitizer.sh; fi
  if $long; then
    keep long check crankloop_program tools/check --long
    [ -s "$logs/mutants.log" ] || { echo tests/mutants.sh --count 40 --areas && cat build/check-logs/mutants.log; } >"$logs/mutants.log"
  fi
fi

# ---- the page --------------------------------------------------------------------------------------------------------

command_of() { printf '    %s\n\n' "$(head -n 1 "$logs/$1.log")"; }
# figures LOG: its "[ figures  ]" lines as a list, with the test's scalar.
figures() {
  awk '
    /^\[ RUN / { real = $0 ~ /\/Float/ ? "float" : $0 ~ /\/Double/ ? "double" : "" }
    /^\[ figures  \]/ { sub(/^\[ figures  \] */, ""); print "- " (real != "" ? real ": " : "") $0 }
    /^\[  FAILED  \]/ && !told[$0]++ { print "- **" $0 "**" }' "$logs/$1.log"
}

{
  cat <<'TEXT'
# Reliability

What was tried to break crankloop, and what came of it. This page is written by tests/reliability.sh from the logs of the commands it names;
docs/contract.md says what is promised.

## What runs when

`tools/check --all`, which every change has to pass, runs each proof once, where it costs least; `tools/check --long` runs what proves least for its time,
before a release and after a change of core. `tools/check --list` names the parts.

| proof | every change, `--all` | `--long` |
| --- | --- | --- |
| host tests, assertions and lanes on | all, g++ -O2, test sources -O1 (`host`, `slow`) | under the thread sanitizer (`thread`) |
| address and undefined-behaviour sanitizers, assertions on, clang++ -O1 | unit and golden tests (`sanitize`); fuzz targets, 15 s each (`fuzz`) | the rest, and FMUs with their importer (`sanitize_rest`) |
| clang++ -O2, no assertions | golden, quick contract tests, self-check (`clang`) | the rest (`clang_rest`) |
| same bits | eight builds by two compilers (`same_bits`) | |
| 64-bit Arm Linux, emulated | golden, self-check (`aarch64`) | the rest but for the longest (`aarch64_rest`) |
| 64-bit Windows, by Wine | self-check (`windows`) | FMUs: the same bits as on Linux (`windows_rest`) |
| Cortex-M4F, M7, M33, R5F, RV32IMAFC, emulated | self-check, costs, bounds, 50 000 hostile ticks | 10^6 hostile ticks on a Cortex-M4F (`hostile`) |
| figures of README and docs, benchmark's instructions and errors, demonstration | `figures`, `bench`, `demo` | |
| the tests themselves | | a sample of single-point changes of core (`mutants`) |

## Random valve trains

Each of these cases is a valve train and an operating point drawn from a seed (tools/lab/stress/stress_case.hpp has the ranges). It is
refused at set-up for a reason that is worked out anew, or runs through 20 cycles, at most 40 000 ticks, in finite numbers and within a bound
on its energy; every tenth is compared with the converged reference (tools/lab/stress/stress_trial.hpp has the rules).
`--case N` runs one of them again.

TEXT
  # shellcheck disable=SC2016  # the shell of who repeats it expands it
  run=$(sed -n 's/ --seed [0-9]*/ --seed $seed/p;q' "$logs/stress-1.log")
  # shellcheck disable=SC2046  # a list of numbers
  printf '    for seed in%s; do %s; done\n\n' "$(printf ' %s' $(sed -n 's/^seed = //p' "$logs"/stress-[0-9]*.log | sort -n))" "$run"
  awk -F ' = ' '
    FNR == 1 { ++runs; next }
    / = / && $1 != "failure" && $1 != "seed" {
      name = $1; value = $2
      if (name == "refused") { split($0, parts, "# "); name = "refused: " parts[2]; sub(/ .*/, "", value) }
      if (!(name in figure)) order[++count] = name
      if (name !~ /error/) figure[name] += value
      else if (value + 0 > figure[name] + 0) figure[name] = value
    }
    END {
      print "| figure | of " runs " runs |\n| --- | --- |"
      for (i = 1; i <= count; ++i) printf "| %s | " (order[i] ~ /error/ ? "%.3g" : "%.0f") " |\n", order[i], figure[order[i]]
    }' "$logs"/stress-[0-9]*.log
  grep -h '^failure' "$logs"/stress-[0-9]*.log | sed 's/^failure = /- /' || true
  cat <<'TEXT'

Counts are of all runs together, errors the largest of any. `error_of_class` is the largest error of a case over the accuracy asked for,
`error_of_allowed` over what the rule allows; p99 is what 99 of 100 comparisons stay below. `landed` counts the comparisons in which
the valve came back to its seat: the others end before, or stand. `--smooth` draws damped trains with smooth cams below float, whose error is that of
the steps alone. `judged_again` is how often copies of the
reference were too few to judge by and more of them did. `stability_limit_error` is the largest distance of the measured from the
theoretical longest stable step, as a part of it, at 41 damping ratios from 0 to 2; `--report` draws the map.

## Faults in a running engine

Four cylinders, eight elastic valves, a measured crank at 6000 rpm; one engine is hurt at a random tick, another runs beside it.

TEXT
  command_of faults
  figures faults
  printf '\n## Soak\n\nUp and down through the speeds again and again: the same bits in each drive, and no denormal number in any state.\n'
  printf 'tools/check slow runs 10^7 ticks; with CRANKLOOP_LONG_TESTS=1 in the environment it is 10^9.\n\n'
  command_of soak
  figures soak
  printf '\n## Edges of tables\n\n'
  command_of edges
  figures edges
  printf '\n## Fuzzing\n\nAny bytes, under the address and undefined-behaviour sanitizers; 0 findings, or the part of tools/check fails.\n\n'
  command_of fuzz
  for log in "$logs"/fuzz-*.log; do
    name=${log##*/fuzz-}
    sed -n "s/^Done \\([0-9]*\\) runs in \\([0-9]*\\) second(s)\$/- ${name%.log}: \\1 inputs in \\2 s/p" "$log"
  done
  tail -n 1 "$logs/fuzz.log" | sed 's/^/- targets: /'
  printf '\n## Sanitizers\n\n'
  cat <<'TEXT'
Address and undefined behaviour (float-cast-overflow and float-divide-by-zero among it), and threads; any finding fails a test. What has
no line here was not run for this page.

TEXT
  if [ -s "$logs/long.log" ]; then
    printf '`tools/check --long` on %s:\n\n' "$(date -r "$logs/long.log" +%Y-%m-%d)"
    awk '/^-- / { title = substr($0, 4) } /^   [0-9]+ passed/ { sub(/^ */, ""); sub(/;.*/, ""); print "- " title ": " $0 }' "$logs/long.log"
  fi
  printf -- '- %s: %s\n' "$(head -n 1 "$logs/threads.log")" "$(sed -n 's/^\[  \([A-Z]*\)  \] /\1 /p' "$logs/threads.log" | head -n 1)"
  if [ -s "$logs/numerical.log" ]; then
    cat <<'TEXT'

The numerical sanitizer (clang 19) runs the tick in float with a double beside every number, and names each line where the two part by more
than 2^-10 of the number. It cannot pass or fail: a gap of a micrometre between two lifts of millimetres, a force made of it, and
anything that goes through zero have lost digits, by nature. What that amounts to in the outputs is the error of the lift in float,
which the stress test and docs/performance.md measure. The lines that it names most often, of all that it names:

TEXT
    command_of numerical
    sed -n '2,9p' "$logs/numerical.log"
    printf -- '- and %d lines more\n' "$(($(wc -l <"$logs/numerical.log") - 9))"
  fi
  printf '\n## Branches of core and of the C interface that the host tests take\n\n'
  command_of coverage
  sed -n 's/^\([a-z_]* = .*\)/- \1/p' "$logs/coverage.log"
  cat <<'TEXT'

The command lists each branch that is not taken, with its line. tests/coverage_exceptions.conf has the reason of each; a branch
without a reason, or a reason without a branch, fails the command.

## Mutants

Single-point changes of core, drawn from a seed: a comparison, + - * /, a constant, a condition, a negation, a statement that is left out. Lanes
and the C interface are not among them. The areas gas, trigger and valve are those folders of core/include/crankloop/tick; tabulate is set-up, with the checks of
definitions; fmi is port/fmi/include/crankloop/fmi.

Tests of behaviour judge first: the library's own unit, property and interface tests, for fmi those of tests/fmi, with assertions, and of them only those that
reach the mutant's place. The command fails when they notice less than 90 % of an area's mutants that are no equivalents. The golden tests judge what is left. They
hold the bits of every output, so they notice almost anything, but the next change that is meant to move bits renews them: what they alone notice is counted apart.
A mutant that no test notices is an equivalent, which no test could tell, or survives; tests/mutants/survivors.conf has the reason of each.

TEXT
  command_of mutants
  sed -n 's/^\([a-z]* = .*\)/- \1/p' "$logs/mutants.log"
  # shellcheck disable=SC2016  # code in Markdown
  sed -n 's/^by golden bits alone: \(core[^ ]*\|port[^ ]*\)  \([^|]*[^ |]\)  |  \(.*\)/- \1, `\3`, \2: by golden bits alone/p
    s/^\(core[^ ]*\|port[^ ]*\)  \([^|]*[^ |]\)  |  \(.*\): \(equivalent\|survives\): /- \1, `\3`, \2: \4: /p' "$logs/mutants.log"
  cat <<'TEXT'

## What fuzzing and stress found

- A definition could hold a positive number so small that its reciprocal is infinite: a seat of 5e-312 N/m, a lever of 5e-313 m. What must be
  greater than zero is now at least 1e-9.
- A source or kind beyond the last enumerator was taken for the last one in C++ definitions.
- A number that names no integrator was taken for Runge-Kutta.
- Four knocked copies of the reference are too few to tell chaos from error once in some ten thousand comparisons (seed 2, case 9730: 37 times
  the accuracy asked for, 1.09 times what its own four copies excuse, 0.29 to 0.98 times what six other draws of four do): 32 judge again.
- A valve that trembled on a soft seat by more than its lash was taken for quiet, and stepped over its train: up to 120 um off.
- The accuracy class was promised for any valve; with Runge-Kutta it holds for vibrations of up to 0.24 mm (docs/contract.md).

## Known gaps

- Flipped bits of a running state are found only where the caller checks it (docs/contract.md "Flipped bits").
TEXT
} >docs/reliability.md
echo "docs/reliability.md is written from $logs"
