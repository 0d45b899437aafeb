#!/bin/sh
# mutants.sh [--seed N] [--count N] [--areas | --area NAME... | --only REGEX...] [BUILD_DIR]
# How many single-point changes of core the tests notice: a sample of COUNT (60) of what tests/mutants/mutate.cpp can
# change. --areas draws COUNT of each of the areas gas, crank, trigger, tabulate, valve, c and fmi, --area of those
# named, --only in files whose paths have REGEX, such as tick/valve/. Lanes are left out: they have tests of their own.
#
# All mutants of a sample are in one build, with assertions; CRANKLOOP_MUTANT=N makes a run the mutant N. Each is judged
# by the tests that reach its place, the quickest and closest first, up to the first that fails: by those of behaviour,
# which are the library's own unit, property and interface tests; and when none of them notices it, by tests/golden,
# which holds bits. The areas c and fmi, which are folders of port, have tests of behaviour of their own: those of the C
# interface, and tests/fmi. As many mutants are judged at a time as there are processors. A run is also over after at
# least twice the processor time that the tests take without a change, or when it asks for 4 GiB. Places that no test
# reaches, since the compiler has computed there what is to be computed or since tests/coverage_exceptions.conf says
# why, are listed and replaced by the next of the sample.
#
# Fails when tests of behaviour notice under 90 % of an area's mutants that are no equivalents, when no test at all
# notices one that tests/mutants/survivors.conf does not know, or when that file names code that is gone. Last line: "N
# passed, M failed".
set -eu
CDPATH='' cd -- "$(dirname -- "$0")/.."
seed=1 count=60 areas='' build=build/mutants
usage() { sed -n '2,/^[^#]/s/^# \{0,1\}//p' tests/mutants.sh >&2 && exit 2; }
all_areas='gas crank trigger tabulate valve c fmi'
# add_area NAME: "NAME=REGEX", as mutate takes them.
add_area() {
  case $1 in
    gas | crank | trigger | valve) areas="$areas $1=/tick/$1/" ;;
    tabulate) areas="$areas $1=/(tabulate|define)/" ;;
    c | fmi) areas="$areas $1=^port/$1/" ;;
    *) usage ;;
  esac
}
while [ $# -gt 0 ]; do
  case $1 in
    --seed | --count)
      case ${2:-} in '' | *[!0-9]*) usage ;; esac
      if [ "$1" = --seed ]; then seed=$2; else count=$2; fi
      shift 2
      ;;
    --areas) for area in $all_areas; do add_area "$area"; done && shift ;;
    --area) add_area "${2:-}" && shift 2 ;;
    --only)
      case ${2:-} in '' | *[[:space:]]*) usage ;; esac
      areas="$areas $2=$2" && shift 2
      ;;
    -*) usage ;;
    *) build=$1 && shift ;;
  esac
done
areas=${areas:-core=.}
jobs=$(nproc 2>/dev/null || echo 1)
drawn=$((count * 3 / 2)) # some are never reached
mkdir -p "$build"
build=$(CDPATH='' cd -- "$build" && pwd)
tab=$(printf '\t')

# ---- survivors.conf --------------------------------------------------------------------------------------------------

grep '^[^#[:space:]]' tests/mutants/survivors.conf | while IFS=$tab read -r file change code; do
  grep -qF -e "$code" "$file" 2>/dev/null || printf '%s: %s\n' "$file" "$code"
done >"$build/gone"
[ ! -s "$build/gone" ] || { echo 'tests/mutants/survivors.conf: gone:' >&2 && cat "$build/gone" >&2 && exit 1; }

# ---- the build -------------------------------------------------------------------------------------------------------

quietly() { "$@" >"$build/build.log" 2>&1 || { tail -n 40 "$build/build.log" >&2 && exit 1; }; }
quietly cmake -S tests/mutants -B "$build/mutate" -DCMAKE_BUILD_TYPE=Release
quietly cmake --build "$build/mutate"

# behaviour_of AREA: the judge of its behaviour; that of core has golden bits beside it.
behaviour_of() { case $1 in c | fmi) echo "$1" ;; *) echo behaviour ;; esac; }
judges=
for area in $areas; do judges="$judges $(behaviour_of "${area%%=*}")"; done
case $judges in *behaviour*) judges="$judges golden" ;; esac
# Behaviour last: it takes the longest to compile, and all is compiled anew when a change is left out.
judges=$(for judge in $judges; do echo "$judge"; done | sort -ur)
# program_of JUDGE: the target that builds it, an executable of that name in build/judge.
program_of() { case $1 in behaviour) echo judge ;; *) echo "judge_$1" ;; esac; }

# Sees whether every change compiles, first in the library alone. One that does not is left out; the compiler names its
# line, or the next, in which the expression goes on.
: >"$build/left_out"
made=
while [ -z "$made" ]; do
  # shellcheck disable=SC2086  # a list of words
  "$build/mutate/mutate" . "$build/mutated" "$seed" "$drawn" "$build/left_out" $areas >"$build/mutants" 2>"$build/places"
  quietly cmake -S tests/mutants -B "$build/judge" -DMUTATED="$build/mutated" -DCMAKE_RUNTIME_OUTPUT_DIRECTORY="$build/judge"
  made=true
  for target in core $(for judge in $judges; do program_of "$judge"; done); do
    cmake --build "$build/judge" --target "$target" --parallel "$jobs" >"$build/build.log" 2>&1 && continue
    cut -f 3 "$build/mutants" | sort -u >"$build/changed"
    sed -n 's#^[^ ]*/\(\(core\|port/c\|port/fmi\)/[a-z_0-9/.]*:[0-9]*\)[:,].*#\1#p' "$build/build.log" |
      awk -F : '{ print $1 ":" $2; print $1 ":" $2 - 1 }' | sort -u | comm -12 "$build/changed" - >"$build/refused"
    [ -s "$build/refused" ] || { tail -n 40 "$build/build.log" >&2 && exit 1; }
    cat "$build/refused" >>"$build/left_out"
    made=
    break
  done
done

# ---- which tests reach which place -----------------------------------------------------------------------------------

# Not those that take seconds to do again what others do.
slow='*LastsThroughLongStandstill*:*IsTheSameAfterManyCycles*:Soak*:FaultInjection*:ValveOfAnyDesign*:ValveTicks.FromOne*'
slow=$slow':Versions/Ticks.AreNeitherLost*'
for judge in $judges; do
  program=$build/judge/$(program_of "$judge")
  if [ -e "$build/reach-$judge" ] && [ -z "$(find "$program" -newer "$build/reach-$judge")" ]; then continue; fi
  rm -f "$build"/reach.part*
  shards='' parts='' i=0
  while [ "$i" -lt "$jobs" ]; do
    GTEST_TOTAL_SHARDS=$jobs GTEST_SHARD_INDEX=$i CRANKLOOP_MUTANT_REACH=$build/reach.part$i \
      "$program" --gtest_brief=1 --gtest_filter="-$slow" >"$build/unchanged.log$i" 2>&1 &
    shards="$shards $!" parts="$parts $build/reach.part$i"
    i=$((i + 1))
  done
  for shard in $shards; do wait "$shard" || { cat "$build"/unchanged.log* | tail -n 40 >&2 && exit 1; }; done
  # shellcheck disable=SC2086  # a list of words
  cat $parts >"$build/reach-$judge"
done

# tests_of JUDGE NUMBER: those that reach the mutant's place, first the quickest that reach the fewest places, together
# 30 s at most; all where it is reached before any test. As filters of GoogleTest, which keeps to no order within one: of
# what takes a tenth of a second together, then twice as long each time; each behind the seconds that a mutant may take.
tests_of() {
  awk -v number="$2" '
    {
      here = 0
      for (i = 3; i <= NF; ++i) here = here || $i == number
      if ($1 == "-") before = here
      else if (here || before) print ($2 + 1) * NF, $2, $1
    }' "$build/reach-$1" | sort -n | awk '
    BEGIN { part = 0 }
    { took += $2 }
    took <= 30000 {
      while (took > 100 * 2 ^ part) ++part
      ms[part] += $2
      filter[part] = filter[part] ":" $3
    }
    END {
      for (i = 0; i <= part; ++i)
        if (filter[i] != "") print 5 + int(ms[i] / 500), "--gtest_filter=" substr(filter[i], 2)
    }'
}

# ---- the judgement ---------------------------------------------------------------------------------------------------

# reason_of FILE CHANGE CODE: "equivalent" or "survives", and why, of a mutant that survivors.conf knows.
reason_of() {
  awk -F '\t' -v file="${1%:*}" -v change="$2" -v code="$3" '
    /^[^#\t]/ { known = $1 == file && $2 == change && index(code, $3) > 0; next }
    /^\t/ && known { sub(/^\t/, ""); print; found = 1 }
    END { exit !found }' tests/mutants/survivors.conf
}

# passes JUDGE NUMBER: the mutant in the tests of each of the filters; what it printed is in $mine/log.
passes() {
  tests_of "$1" "$2" >"$mine/filters"
  while read -r seconds filter; do
    printf '%s\n' "$filter" >"$mine/flags"
    # shellcheck disable=SC3045  # every shell that is /bin/sh somewhere has ulimit -t and -v
    (ulimit -t "$seconds" && ulimit -v 4194304 && CRANKLOOP_MUTANT=$2 exec "$build/judge/$(program_of "$1")" --gtest_flagfile="$mine/flags" --gtest_fail_fast --gtest_brief=1) \
      >"$mine/log" 2>&1 </dev/null || return 1
  done <"$mine/filters"
}

# by_what: the test that failed; a mutant may also crash, or not end.
by_what() {
  test=$(sed -n 's/^\[  FAILED  \] \([A-Za-z_0-9/.]*\).*/\1/p' "$mine/log" | head -n 1)
  echo "by ${test:-its end}"
}

# Judges what comes in, each line of which is a mutant, and says "VERDICT<TAB>NUMBER<TAB>AREA<TAB>what to tell of it".
judge_all() {
  mine=$build/worker$1
  mkdir -p "$mine"
  while IFS=$tab read -r number area place change code; do
    mutant="$place  $change  |  $code"
    behaviour=$(behaviour_of "$area")
    reason=$(reason_of "$place" "$change" "$code") || reason=
    if ! passes "$behaviour" "$number" 2>"$mine/ended"; then
      verdict=noticed tell="noticed: $mutant  |  $(by_what)"
    elif [ "$behaviour" = behaviour ] && ! passes golden "$number" 2>"$mine/ended"; then
      verdict=golden tell="by golden bits alone: $mutant${reason:+  |  $reason}"
      # An equivalent changes no bit.
      case $reason in equivalent*) verdict=unknown tell="NO EQUIVALENT, golden bits notice it: $mutant" ;; esac
    else
      case $reason in
        '') verdict=unknown tell="SURVIVES: $mutant" ;;
        equivalent*) verdict=equivalent tell="$mutant: $reason" ;;
        *) verdict=survived tell="$mutant: $reason" ;;
      esac
    fi
    printf '%s\t%s\t%s\t%s\n' "$verdict" "$number" "$area" "$tell"
  done
}

# Of each area as many as were asked for.
: >"$build/sample"
while IFS=$tab read -r number area place change code; do
  [ "$(grep -cF "$tab$area$tab" "$build/sample")" -lt "$count" ] || continue
  if [ -z "$(tests_of "$(behaviour_of "$area")" "$number")" ]; then
    printf '%s\n' "not reached: $place  $change  |  $code"  # a character '\0' as it stands
  else
    printf '%s\t%s\t%s\t%s\t%s\n' "$number" "$area" "$place" "$change" "$code" >>"$build/sample"
  fi
done <"$build/mutants"

i=0
while [ "$i" -lt "$jobs" ]; do
  sort -t "$tab" -k 2,2 -k 1,1n "$build/sample" | awk -v jobs="$jobs" -v i="$i" 'NR % jobs == i' | judge_all "$i" >"$build/verdicts$i" &
  i=$((i + 1))
done
wait
i=0 verdicts=
while [ "$i" -lt "$jobs" ]; do verdicts="$verdicts $build/verdicts$i" i=$((i + 1)); done
# shellcheck disable=SC2086  # a list of words
sort -t "$tab" -k 3,3 -k 2,2n $verdicts >"$build/verdicts"
cut -f 4- "$build/verdicts"

# ---- the counts ------------------------------------------------------------------------------------------------------

echo "date = $(date +%F)"
echo "seed = $seed"
failed=0 short=0
for area in $areas; do
  area=${area%%=*}
  of() { awk -F '\t' -v verdict="$1" -v area="$area" '$1 == verdict && $3 == area { ++n } END { print n + 0 }' "$build/verdicts"; }
  noticed=$(of noticed) golden=$(of golden) equivalent=$(of equivalent) survived=$(($(of survived) + $(of unknown)))
  mutants=$((noticed + golden + equivalent + survived))
  echo "$area = $mutants mutants of $(awk -F '\t' -v area="$area" '$1 == area { print $2 }' "$build/places") places: $noticed noticed by behaviour," \
    "$golden by golden bits alone, $survived not at all, $equivalent equivalent"
  failed=$((failed + $(of unknown)))
  if [ $((10 * noticed)) -lt $((9 * (mutants - equivalent))) ]; then
    echo "$area: tests of behaviour notice under 90 % of the mutants that are no equivalents"
    failed=$((failed + 1))
  fi
  [ "$mutants" -eq "$count" ] || { echo "$area: only $mutants of $count mutants are reached" && short=1; }
done
echo "$(($(wc -l <"$build/verdicts") - $(grep -c "^unknown$tab" "$build/verdicts" || :))) passed, $((failed + short)) failed"
[ "$failed" -eq 0 ] && [ "$short" -eq 0 ]
