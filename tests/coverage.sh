#!/bin/sh
# coverage.sh [--report]
# Which branches of core and of the C interface the host tests take, by clang++ and llvm-cov. Every branch that they do
# not take must have its reason in tests/coverage_exceptions.conf, and every reason there a branch: else the exit status
# is 1.
#
#   tests/coverage.sh           builds the tests in build/coverage, runs them, reports
#   tests/coverage.sh --report  reports of the last run, and of what was built for it
#
# A branch is one way of a condition, or a case of a switch. Of a template it counts as taken if any of its
# instantiations takes it. Prints `name = value` lines, then FILE:LINE:COLUMN of each branch that is never taken one
# way, those without a reason last.
set -eu
CDPATH='' cd -- "$(dirname -- "$0")/.."
folder=build/coverage
profile=$folder/profile

programs=$folder/bin/crankloop
targets=
for kind in unit property golden contract tools; do
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
    # %m tells programs apart: tests also start the program itself, whose counts are its own.
    LLVM_PROFILE_FILE="$PWD/$profile/of-%m" "$program" --help >/dev/null 2>&1 || :  # one refuses it
    of=$(cd "$profile" && echo of-*)
    rm "$profile/$of"
    echo "${of#of-}" >"$profile/${program##*/}.signature"
    # Not the long ones that do nothing new: 10^7 ticks again and again.
    [ "${program##*/}" = crankloop ] || LLVM_PROFILE_FILE="$PWD/$profile/%m-%p.profraw" "$program" --gtest_brief=1 \
      --gtest_filter="-*LastsThroughLongStandstill*:*IsTheSameAfterManyCycles*:Soak*" >"$profile/${program##*/}.log" 2>&1 ||
      echo "# tests failed: $profile/${program##*/}.log"
  done
  for program in $programs; do
    name=${program##*/}
    # Of a program that a test kills there is half a profile.
    llvm-profdata merge --sparse --failure-mode=all -o "$profile/$name.profdata" "$profile/$(cat "$profile/$name.signature")"-*.profraw
  done
fi

# What llvm-cov shows of each program by itself: scenes of two test programs may have one name, and it would count
# neither.
for program in $programs; do
  llvm-cov show --show-branches=count --show-expansions=false "$program" --instr-profile="$profile/${program##*/}.profdata" \
    --ignore-filename-regex='^/usr/'
done >"$profile/shown" 2>"$profile/shown.log"

# "    52|   8|code" and behind such lines "  |  Branch (52:7): [True: 8, False: 0]"; the counts of a template's instantiations come one
# after the other.
awk '
  /^\/.*:$/ { file = $0; sub(/:$/, "", file); sub(/.*\/core\//, "core/", file); sub(/.*\/port\/c\//, "port/c/", file) }
  file !~ /^(core\/(include|src)|port\/c)\// { next }
  file ~ /crankloop\/variables\.hpp/ { next }  # shared objects that tests/fmi loads: not these programs
  match($0, /^ *[0-9]+\| *[0-9.]+[kMGTE]?\|/) {
    split($0, column, "|")
    line = file ":" column[1] + 0
    if (!(line in lines)) { lines[line] = 0; ++all_lines }
    if (column[2] != 0 && !lines[line]) { lines[line] = 1; ++covered_lines }
  }
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
  END {
    printf "lines = %d\nlines_covered = %.2f%%\n", all_lines, 100 * covered_lines / all_lines
    for (branch in seen) print (branch in taken ? "taken " : "not ") branch | "sort -t: -k1,1 -k2,2n -k3,3n >" branches
  }' branches="$profile/branches" "$profile/shown"

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
