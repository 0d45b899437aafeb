#!/bin/sh
# check_counts.sh CHECKOUT: tools/check counts what its logs say. Each case is what a part's command prints, how it
# ends, and what has to be counted: "passed failed skipped".
set -eu
cd "$1"
. tools/common.sh
. tools/counting.sh
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
may_be_skipped=$folder/may_be_skipped.conf
cat >"$may_be_skipped" <<'END'
# a comment, and a blank line

*  contract.anywhere  what it needs is not everywhere
m4,m7  target.costs  the compiler is another
*  contract.no_reason
END

bad=0
# counts "PASSED FAILED SKIPPED" KIND WHERE STATUS LINE...
counts() {
  expected=$1 kind=$2 where_run=$3 status=$4
  shift 4
  printf '%s\n' "$@" >"$folder/printed"
  passed=0 failed=0 skipped=0
  "test_$kind" "$where_run" "$folder/log" sh -c "cat '$folder/printed'; exit $status" >"$folder/said" 2>&1
  [ "$passed $failed $skipped" = "$expected" ] && return
  printf 'expected %s, counted %s %s %s of a %s that ends with %s and prints:\n' "$expected" "$passed" "$failed" "$skipped" "$kind" "$status"
  cat "$folder/printed"
  bad=$((bad + 1))
}

counts '345 0 0' ctest m4 0 '100% tests passed, 0 tests failed out of 345'
counts '343 2 0' ctest m4 8 '99% tests passed, 2 tests failed out of 345' '' 'The following tests FAILED:' '	  5 - a.bad (Failed)' '	  6 - a.gone (Not Run)'
# It fails, but does not say what; it says nothing at all.
counts '345 1 0' ctest m4 1 '100% tests passed, 0 tests failed out of 345'
counts '0 1 0' ctest m4 0 'No tests were found!!!'
# Of a project that a test builds and tests, only a part of the log.
counts '5 0 0' ctest m4 0 '50% tests passed, 1 tests failed out of 2' '100% tests passed, 0 tests failed out of 5'

# ctest counts those skipped as passed. They may be, or count as failed.
closing='100% tests passed, 0 tests failed out of 5'
counts '3 0 2' ctest m4 0 "$closing" '' 'The following tests did not run:' '	  2 - contract.anywhere (Skipped)' '	 13 - target.costs (Skipped)'
counts '4 1 0' ctest m4 0 "$closing" '' 'The following tests did not run:' '	  2 - unit.Crank.Turns (Skipped)'
grep -q 'unit.Crank.Turns was left out' "$folder/said" || { echo 'a test that may not be skipped is not named' && bad=$((bad + 1)); }
counts '3 1 1' ctest m5 0 "$closing" '' 'The following tests did not run:' '	  2 - contract.anywhere (Skipped)' '	 13 - target.costs (Skipped)'
grep -q 'skipped contract.anywhere: what it needs is not everywhere' "$folder/said" || { echo 'a reason is not told' && bad=$((bad + 1)); }
counts '4 1 0' ctest m4 0 "$closing" '' 'The following tests did not run:' '	  2 - contract.no_reason (Skipped)'
# Those disabled it does not count.
counts '5 1 0' ctest m4 0 "$closing" '' 'The following tests did not run:' '	  6 - unit.Crank.Stops (Disabled)'
# What failed and what may not be skipped are told together.
counts '2 3 0' ctest m4 8 '60% tests passed, 2 tests failed out of 5' '' 'The following tests did not run:' '	  2 - unit.Crank.Turns (Skipped)' '' \
  'The following tests FAILED:' '	  5 - a.bad (Failed)' '	  6 - b.bad (Failed)'
# A test's own words are not ctest's.
counts '5 0 0' ctest m4 0 '  7 - unit.Crank.Turns (Skipped)' 'skipped unit.Crank.Turns: it says so itself' "$closing"

counts '10 0 0' script bits 0 'g++ -O2: same bits' '10 passed, 0 failed'
counts '9 1 0' script bits 1 '9 passed, 1 failed'
counts '10 1 0' script bits 1 '10 passed, 0 failed'
counts '0 1 0' script bits 0 'nothing'
counts '0 1 0' script bits 0 '0 passed, 0 failed'
counts '1 0 1' script m7 0 'skipped target.costs: no such compiler' '1 passed, 0 failed'
counts '1 1 0' script bits 0 'skipped target.costs: no such compiler' '1 passed, 0 failed'

passed=0 failed=0
test_command "$folder/log" true
test_command "$folder/log" false 2>"$folder/said"
[ "$passed $failed" = '1 1' ] || { echo "of a command that does well and one that fails: $passed passed, $failed failed" && bad=$((bad + 1)); }

# ---- what the environment must not do --------------------------------------------------------------------------------
left=$(
  export GTEST_TOTAL_SHARDS=2 GTEST_FILTER=-Crank.\* GTEST_REPEAT=0 ASAN_OPTIONS=exitcode=0 LSAN_OPTIONS=a UBSAN_OPTIONS=b TSAN_OPTIONS=c
  clean_environment
  env | grep -E '^GTEST_|SAN_OPTIONS=' || true
)
[ -z "$left" ] || { echo "left in the environment: $left" && bad=$((bad + 1)); }

for seconds in 0 00 -1 1.5 15s all; do
  if said=$(CRANKLOOP_FUZZ_SECONDS=$seconds tools/check --list 2>&1) || [ "$said" != "check: CRANKLOOP_FUZZ_SECONDS is '$seconds': a number of seconds is needed, 1 or more" ]; then
    echo "tools/check with CRANKLOOP_FUZZ_SECONDS=$seconds says: $said"
    bad=$((bad + 1))
  fi
done
for seconds in 1 15 360; do
  CRANKLOOP_FUZZ_SECONDS=$seconds tools/check --list | grep -q "^fuzz: .* $seconds s each" || { echo "CRANKLOOP_FUZZ_SECONDS=$seconds is not taken" && bad=$((bad + 1)); }
done

# ---- the list --------------------------------------------------------------------------------------------------------
# Every line of it has a reason.
awk '!/^#/ && NF > 0 && NF < 4 { print "tests/may_be_skipped.conf:" NR ": no reason"; bad = 1 } END { exit bad }' tests/may_be_skipped.conf || bad=$((bad + 1))

# ---- the parts -------------------------------------------------------------------------------------------------------
# Each runs what is its own: one without a line ends in "no command" only when it is run.
own=$(sed -n '/^run_part()/,/^}/s/^    \([^*)]*\)) .*/\1/p' tools/check | tr '|\n' '  ')
for part in $(sed -n "s/^\(all\|long\)_parts='\(.*\)'\$/\2/p" tools/check); do
  case " $own " in
    *" $part "*) ;;
    *) echo "tools/check lists the part $part and does not run it" && bad=$((bad + 1)) ;;
  esac
done
[ "$bad" -eq 0 ]
