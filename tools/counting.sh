# shellcheck shell=sh
# What tools/check counts: tests that passed, failed, or were skipped. Sourced by it, after common.sh;
# tests/contract/check_counts.sh feeds it with logs. A skipped test counts as neither passed nor failed where
# tests/may_be_skipped.conf has it, else as failed.

passed=0
failed=0
skipped=0
may_be_skipped=tests/may_be_skipped.conf

# What a developer's environment may hold that makes tests leave things out or end well: GoogleTest's filters and
# shards, the sanitizers' exit codes and suppressions.
clean_environment() {
  for variable in $(env | sed -nE 's/^(GTEST_[A-Z_]*|(A|L|T|UB)SAN_OPTIONS)=.*/\1/p'); do unset "$variable"; done
}

# test_command LOG command...: counts as one test.
test_command() {
  if run_logged "$@"; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
  fi
}

# test_ctest WHERE LOG command...: ctest, whose closing line is "99% tests passed, 2 tests failed out of 345". It counts
# those skipped as passed, and those disabled not at all.
test_ctest() {
  count_by 's/^[0-9]*% tests passed, \([0-9]*\) tests\{0,1\} failed out of \([0-9]*\)$/\1 \2/p' \
    '/^The following tests did not run:$/,/^$/s/^[[:space:]]*[0-9]* - \(.*\) (\([A-Za-z]*\))$/\2 \1/p' "$@"
}

# test_script WHERE LOG command...: a script whose last line is "N passed, M failed"; what it left out, and did not
# count, it has told before by lines "skipped NAME: why".
test_script() {
  count_by 's/^\([0-9]*\) passed, \([0-9]*\) failed$/\2 \1+\2/p' 's/^skipped \([^ :]*\): .*$/Told \1/p' "$@"
}

# count_by SED_COUNTS SED_SKIPPED WHERE LOG command...: runs the command and adds to the counts what it says. SED_COUNTS
# turns its closing line into "FAILED TOTAL", SED_SKIPPED each line about a test left out into "HOW NAME". A run that
# failed, or says nothing, cannot count as passed.
count_by() {
  closing_line=$1 left_out=$2 where=$3 log=$4
  shift 4
  if "$@" </dev/null >"$log" 2>&1; then all_well=true; else all_well=false; fi
  counts=$(sed -n "$closing_line" "$log" | tail -n 1)
  failures=$((${counts%% *} + 0))
  total=$((${counts##* } + 0))
  if [ "$failures" -eq 0 ] && { [ "$all_well" = false ] || [ "$total" -eq 0 ]; }; then failures=1 total=$((total + 1)); fi
  sed -n "$left_out" "$log" | sort -u >"$log.skipped"
  while read -r how name; do
    [ "$how" = Skipped ] || total=$((total + 1))
    if reason=$(reason_to_skip "$where" "$name"); then
      say "   skipped $name: $reason"
      skipped=$((skipped + 1)) total=$((total - 1))
    else
      say "$name was left out, and $may_be_skipped has no reason for that in $where" >>"$log"
      failures=$((failures + 1))
    fi
  done <"$log.skipped"
  rm "$log.skipped"
  failed=$((failed + failures))
  passed=$((passed + total - failures))
  [ "$failures" -eq 0 ] || {
    say "---- failures; all of it is in $log:"
    grep -vE '^ *Start +[0-9]+:|Passed +[0-9.]+ sec *$' "$log" | tail -n 80
    say "----"
  } >&2
}

# reason_to_skip WHERE NAME: prints why the test may be skipped there; fails where it may not.
reason_to_skip() {
  while read -r wheres test reason; do
    case ,$wheres, in ,\*, | *,"$1",*) [ "$test" = "$2" ] && [ -n "$reason" ] && say "$reason" && return ;; esac
  done <"$may_be_skipped"
  return 1
}
