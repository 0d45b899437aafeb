#!/bin/sh
# demand_line_sees.sh CHECKOUT: what tests/target/demand_line.sh accepts of a self-check in an emulator, and what not.
set -eu
demand_line=$1/tests/target/demand_line.sh
bad=0
# ends STATUS COMMAND...
ends() {
  expected=$1
  shift
  if sh "$demand_line" '^[1-9][0-9]* passed, 0 failed$' "$@" >/dev/null; then status=0; else status=$?; fi
  [ "$status" = "$expected" ] || { echo "expected $expected, but it ends with $status: $*" && bad=$((bad + 1)); }
}
ends 0 sh -c 'echo 12 passed, 0 failed'
ends 0 printf 'golden ok\n12 passed, 0 failed\r\n'
ends 0 sh -c 'echo 12 passed, 0 failed >&2'
ends 1 true
ends 1 false
ends 3 sh -c 'echo 12 passed, 0 failed; exit 3'
ends 1 echo '0 passed, 0 failed'
ends 1 echo '11 passed, 1 failed'
ends 1 echo 'FAILED: 12 passed, 0 failed'
ends 127 no_such_emulator
[ "$bad" -eq 0 ]
