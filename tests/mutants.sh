#!/bin/sh
# mutants.sh [--seed N] [--count N] [--only REGEX] [BUILD_DIR]
# How many single-point changes of core the tests notice: a sample of what tests/mutants/mutate.cpp can change; with
# --only in files whose paths have it, such as tick/valve/. Nothing goes abreast: what lanes have of their own is
# another test's.
#
# All mutants of a sample are in one build, of the library's own unit, property and interface tests, with assertions;
# CRANKLOOP_MUTANT=N makes a run the mutant N. Each is judged by the tests that come by its place, up to the first that
# fails; a run is also over after 60 s of processor time, of which the tests take half at most without a change. Places
# that no test comes by, since the compiler has done there what is to be done or since tests/coverage_exceptions.conf
# says why, are told and replaced by the next of the sample.
#
# Fails when under 90 % of the mutants that are no equivalents are noticed, or one survives that
# tests/mutants/survivors.conf does not know. Last line: "N passed, M failed".
set -eu
CDPATH='' cd -- "$(dirname -- "$0")/.."
seed=1 count=60 only=. build=build/mutants
usage() { sed -n '2,/^[^#]/s/^# \{0,1\}//p' tests/mutants.sh >&2 && exit 2; }
while [ $# -gt 0 ]; do
  case $1 in
    --seed | --count)
      case ${2:-} in '' | *[!0-9]*) usage ;; esac
      if [ "$1" = --seed ]; then seed=$2; else count=$2; fi
      shift 2
      ;;
    --only) [ -n "${2:-}" ] || usage && only=$2 && shift 2 ;;
    -*) usage ;;
    *) build=$1 && shift ;;
  esac
done
jobs=$(nproc 2>/dev/null || echo 1)
drawn=$((count * 3 / 2))  # some are never reached
mkdir -p "$build"
build=$(CDPATH='' cd -- "$build" && pwd)

# ---- the build -------------------------------------------------------------------------------------------------------

quietly() { "$@" >"$build/build.log" 2>&1 || { tail -n 40 "$build/build.log" >&2 && exit 1; }; }
quietly cmake -S tests/mutants -B "$build/mutate" -DCMAKE_BUILD_TYPE=Release
quietly cmake --build "$build/mutate"

# A change that does not compile is left out; the compiler names its place.
: >"$build/left_out"
while :; do
  "$build/mutate/mutate" . "$build/core" "$seed" "$drawn" "$only" "$build/left_out" >"$build/mutants" 2>"$build/places"
  quietly cmake -S tests/mutants -B "$build/judge" -DMUTATED="$build/core"
  cmake --build "$build/judge" --target judge --parallel "$jobs" >"$build/build.log" 2>&1 && break
  cut -f 2 "$build/mutants" | sort -u >"$build/changed"
  sed -n 's|^[^ ]*/\(core/[a-z_/.]*:[0-9]*\)[:,].*|\1|p' "$build/build.log" | sort -u | comm -12 "$build/changed" - >"$build/refused"
  [ -s "$build/refused" ] || { tail -n 40 "$build/build.log" >&2 && exit 1; }
  cat "$build/refused" >>"$build/left_out"
done

# ---- which tests come by which place ---------------------------------------------------------------------------------

# Not those that take seconds to do again what others do. CProgram's runs a program that is not built here.
slow='*LastsThroughLongStandstill*:*IsTheSameAfterManyCycles*:Soak*:FaultInjection*:ValveOfAnyDesign*:ValveTicks.FromOne*:CProgram*'
if [ ! -e "$build/reach" ] || [ -n "$(find "$build/judge/judge" -newer "$build/reach")" ]; then
  if ! CRANKLOOP_MUTANT_REACH=$build/reach.part "$build/judge/judge" --gtest_brief=1 --gtest_filter="-$slow" >"$build/unchanged.log" 2>&1; then
    tail -n 40 "$build/unchanged.log" >&2
    exit 1
  fi
  mv "$build/reach.part" "$build/reach"
fi

# tests_of NUMBER: those that come by the mutant's place, the quickest first, together 30 s at most; all where it is
# reached before any test. Two filters of GoogleTest: what takes a second together, and the rest.
tests_of() {
  awk -v number="$1" '
    {
      here = 0
      for (i = 3; i <= NF; ++i) here = here || $i == number
      if ($1 == "-") before = here
      else if (here || before) print $2, $1
    }' "$build/reach" | sort -n | awk '
    { took += $1 }
    took <= 30000 { filter[took > 1000] = filter[took > 1000] ":" $2 }
    END { for (i = 0; i < 2; ++i) if (filter[i] != "") print "--gtest_filter=" substr(filter[i], 2) }'
}

# ---- the judgement ---------------------------------------------------------------------------------------------------

# reason_of FILE CHANGE CODE: "equivalent" or "survives", and why, of a mutant that survivors.conf knows.
reason_of() {
  awk -F '\t' -v file="${1%:*}" -v change="$2" -v code="$3" '
    /^[^#\t]/ { known = $1 == file && $2 == change && index(code, $3) > 0; next }
    /^\t/ && known { sub(/^\t/, ""); print; found = 1 }
    END { exit !found }' tests/mutants/survivors.conf
}

# passes NUMBER: the mutant in the tests of each of the filters; what it printed is in log.
passes() {
  while read -r filter; do
    printf '%s\n' "$filter" >"$build/flags"
    # shellcheck disable=SC3045  # every shell that is /bin/sh somewhere has ulimit -t
    (ulimit -t 60 && CRANKLOOP_MUTANT=$1 exec "$build/judge/judge" --gtest_flagfile="$build/flags" --gtest_fail_fast --gtest_brief=1) \
      >"$build/log" 2>&1 </dev/null || return 1
  done <"$build/filters"
}

# by_what: the test that failed; a mutant may also crash, or not end.
by_what() {
  test=$(sed -n 's/^\[  FAILED  \] \([A-Za-z_0-9/.]*\).*/\1/p' "$build/log" | head -n 1)
  echo "by ${test:-its end}"
}

tab=$(printf '\t')
judged=0 killed=0 equivalent=0 survived=0 unknown=0
while IFS=$tab read -r number place change code; do
  [ "$judged" -lt "$count" ] || break
  mutant="$place  $change  |  $code"
  tests_of "$number" >"$build/filters"
  if [ ! -s "$build/filters" ]; then
    echo "not reached: $mutant"
    continue
  fi
  judged=$((judged + 1))
  if ! passes "$number" 2>"$build/ended"; then
    killed=$((killed + 1))
    echo "noticed: $mutant  |  $(by_what)"
  elif reason=$(reason_of "$place" "$change" "$code"); then
    case $reason in equivalent*) equivalent=$((equivalent + 1)) ;; *) survived=$((survived + 1)) ;; esac
    printf '%s: %s\n' "$mutant" "$reason"
  else
    unknown=$((unknown + 1))
    echo "SURVIVES: $mutant"
  fi
done <"$build/mutants"

echo "date = $(date +%F)"
echo "places = $(sed -n 's/ places$//p' "$build/places")"
echo "only = $only"
echo "seed = $seed"
echo "mutants = $judged"
echo "noticed = $killed"
echo "equivalent = $equivalent"
echo "survived = $((survived + unknown))"
enough=1
[ $((10 * killed)) -ge $((9 * (judged - equivalent))) ] || { enough=0 && echo 'under 90 % of the mutants that are no equivalents are noticed'; }
echo "$((judged - unknown)) passed, $((unknown + 1 - enough)) failed"
[ "$judged" -eq "$count" ] || echo "only $judged of $count mutants are reached" >&2
[ "$unknown" -eq 0 ] && [ "$enough" -eq 1 ] && [ "$judged" -eq "$count" ]
