#!/bin/sh
# demand_line.sh PATTERN COMMAND...: runs the command and demands both that it ends well and that a line of what it
# prints matches PATTERN (of grep -E): an emulator that runs nothing ends well too.
set -u
pattern=$1
shift
printed=$("$@" 2>&1)
status=$?
printf '%s\n' "$printed"
[ "$status" -eq 0 ] || exit "$status"
printf '%s\n' "$printed" | tr -d '\r' | grep -qE "$pattern" && exit
echo "demand_line.sh: $1 ended well, but no line matches '$pattern'"
exit 1
