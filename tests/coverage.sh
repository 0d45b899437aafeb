#!/bin/sh
# coverage.sh [--report]
# Which branches of core the host tests take, by clang++ and llvm-cov; what they do not take is listed with its line.
#
#   tests/coverage.sh           builds the tests in build/coverage, runs them, reports
#   tests/coverage.sh --report  reports of the last run, and of what was built for it
#
# A template's branch counts as taken if any of its instantiations takes it. Prints `name = value` lines, then a line
# FILE:LINE for each branch that is never taken one way; docs/reliability.md says why.
set -eu
CDPATH='' cd -- "$(dirname -- "$0")/.."
folder=build/coverage
profile=$folder/profile

programs=
targets=
for kind in unit property golden contract; do
  targets="$targets crankloop_${kind}_tests"
  programs="$programs $folder/tests/crankloop_${kind}_tests"
done

if [ "${1:-}" != --report ]; then
  cmake --preset coverage >"$folder-configure.log" 2>&1
  # shellcheck disable=SC2086  # a list of words
  cmake --build --preset coverage --parallel "$(nproc)" --target $targets >"$folder-build.log" 2>&1
  rm -rf "$profile"
  mkdir -p "$profile"
  for program in $programs; do
    # Not the long ones that do nothing new: 10^7 ticks again and again.
    LLVM_PROFILE_FILE="$PWD/$profile/%p.profraw" "$program" --gtest_brief=1 \
      --gtest_filter="-*LastsThroughLongStandstill*:*IsTheSameAfterManyCycles*:Soak*" >"$profile/${program##*/}.log" 2>&1 ||
      echo "# tests failed: $profile/${program##*/}.log"
  done
  llvm-profdata merge --sparse -o "$profile/all.profdata" "$profile"/*.profraw
fi

objects="$folder/bin/crankloop"
for program in $programs; do [ ! -x "$program" ] || objects="$objects --object $program"; done
# shellcheck disable=SC2086  # a list of words
coverage() { llvm-cov "$@" $objects --instr-profile="$profile/all.profdata" --ignore-filename-regex='/(tests|tools|port)/|^/usr/'; }

# The closing line of the table: file, then total, missed, per cent of regions, functions, lines, branches.
coverage report --show-branch-summary | awk '/^TOTAL/ {
  printf "lines = %d\nlines_covered = %s\nbranches = %d\nbranches_not_taken = %d\nbranches_covered = %s\n", $8, $10, $11, $12, $13 }'

# "  |  Branch (52:7): [True: 8, False: 0]" behind the lines of a file; of several instantiations the best counts.
coverage show --show-branches=count --show-expansions=false | awk '
  /^\/.*:$/ { file = $0; sub(/:$/, "", file); sub(/.*\/core\//, "core/", file) }
  match($0, /Branch \([0-9]+:[0-9]+\): \[/) {
    place = substr($0, RSTART + 8); sub(/\).*/, "", place)
    key = file ":" place
    yes = $0; sub(/.*True: /, "", yes); sub(/,.*/, "", yes)
    no = $0; sub(/.*False: /, "", no); sub(/\].*/, "", no)
    if ($0 ~ /Folded/) next
    if (!(key in seen)) { seen[key] = 1; order[++count] = key }
    if (yes != "0") taken[key] = 1
    if (no != "0") passed[key] = 1
  }
  END {
    for (i = 1; i <= count; ++i) {
      key = order[i]
      if (!(key in taken)) print key " never true"
      if (!(key in passed)) print key " never false"
    }
  }' | sort -t: -k1,1 -k2,2n -k3,3n
