#!/bin/sh
# hostile.sh CONF ENGINE...: runs each engine's image of hostile.cpp; fails when a tick has taken more instructions than
# the bound for any input allows. CONF is costs.conf in the build's tests/target. Last line: "N passed, M failed".
set -eu
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
conf=$1
shift
# shellcheck disable=SC1090  # made by CMake
. "$conf"
: "${emulator:?}" "${images:?}"
passed=0 failed=0
for engine in "$@"; do
  image=$images/hostile_$engine
  log=$image.txt
  eval "$emulator \"\$image\"" </dev/null >"$log" 2>&1 || { cat "$log" >&2 && exit 1; }
  worst=$(tr -d '\r' <"$log" | sed -n 's/^hostile //p')
  bound=$("$here/any_input.sh" "$conf" "$image" "$log")
  bound=${bound%% *}
  echo "$engine: worst tick $worst instructions, bound $bound"
  if [ "${worst:-0}" -gt 0 ] && [ "$worst" -le "$bound" ]; then passed=$((passed + 1)); else failed=$((failed + 1)); fi
done
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
