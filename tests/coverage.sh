#!/bin/sh
# coverage.sh [--report]
# Which branches of core the host tests take, by clang++ and llvm-cov. Every branch that they do not take must have its reason in
# tests/coverage_exceptions.conf, and every reason there a branch: else the exit status is 1.
#
#   tests/coverage.sh           builds the tests in build/coverage, runs them, reports
#   tests/coverage.sh --report  reports of the last run, and of what was built for it
#
# A branch is one way of a condition, or a case of a switch. Of a template it counts as taken if any of its instantiations takes it.
# Prints `name = value` lines, then FILE:LINE:COLUMN of each branch that is never taken one way, those without a reason last.
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
coverage report --show-branch-summary | awk '/^TOTAL/ { printf "lines = %d\nlines_covered = %s\n", $8, $10 }'

# "  |  Branch (52:7): [True: 8, False: 0]" behind the lines of a file.
coverage show --show-branches=count --show-expansions=false | awk '
  /^\/.*:$/ { file = $0; sub(/:$/, "", file); sub(/.*\/core\//, "core/", file) }
  match($0, /Branch \([0-9]+:[0-9]+\): \[/) {
    if ($0 ~ /Folded/) next
    place = substr($0, RSTART + 8); sub(/\).*/, "", place)
    key = file ":" place
    yes = $0; sub(/.*True: /, "", yes); sub(/,.*/, "", yes)
    no = $0; sub(/.*False: /, "", no); sub(/\].*/, "", no)
    seen[key " never true"] = seen[key " never false"] = 1
    if (yes != "0") taken[key " never true"] = 1
    if (no != "0") taken[key " never false"] = 1
  }
  END { for (branch in seen) print (branch in taken ? "taken " : "not ") branch }' | sort -t: -k1,1 -k2,2n -k3,3n >"$profile/branches"

# An exception is a line "FILE text of the code", its reason in the indented lines below.
awk -v listed="tests/coverage_exceptions.conf" '
  BEGIN {
    while ((getline line <listed) > 0) {
      if (line ~ /^(#|[ \t]|$)/) continue
      at = index(line, " ")
      file_of[++exceptions] = substr(line, 1, at - 1)
      code_of[exceptions] = substr(line, at + 1)
    }
  }
  function text_of(file, number,    line, i) {
    if (!(file in read_in)) {
      read_in[file] = 1
      while ((getline line <file) > 0) text[file, ++i] = line
    }
    return text[file, number]
  }
  $1 == "taken" { ++taken; next }
  {
    split($2, place, ":")
    code = text_of(place[1], place[2])
    for (i = 1; i <= exceptions; ++i) {
      if (file_of[i] == place[1] && index(code, code_of[i]) > 0) break
    }
    sub(/^[^ ]* /, "")
    if (i <= exceptions) { used[i] = 1; with_reason[++explained] = $0 } else { without[++unexplained] = $0 ":" code }
  }
  END {
    branches = taken + explained + unexplained
    printf "branches = %d\nbranches_not_taken = %d\nbranches_covered = %.2f%%\n", branches, branches - taken, 100 * taken / branches
    for (i = 1; i <= exceptions; ++i) unused += i in used ? 0 : 1
    printf "branches_not_taken_without_a_reason = %d\nreasons_without_a_branch = %d\n", unexplained, unused
    for (i = 1; i <= explained; ++i) print with_reason[i]
    for (i = 1; i <= unexplained; ++i) print "no reason: " without[i]
    for (i = 1; i <= exceptions; ++i) { if (!(i in used)) print "no branch: " file_of[i] " " code_of[i] }
    exit unexplained + unused > 0
  }' "$profile/branches"
