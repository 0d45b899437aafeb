#!/bin/sh
# What the hardest traces cost at set-up, in instructions: docs/contract.md states the bounds.
#
#   setup_cost.sh PROGRAM        fails when one of up to 1536 rows takes more than it may
#   setup_cost.sh PROGRAM all    also those of a million rows: minutes
set -eu
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
# shellcheck source-path=SCRIPTDIR source=instructions.sh
. "$here/instructions.sh"
program=$1
command -v valgrind >/dev/null 2>&1 || { echo 'no valgrind to count instructions with' && exit 1; }

bad=0
for name in $("$program"); do
  case $name in
    million_angles) most=4000000000 ;;
    million_volumes) most=9000000000 ;;
    *) most=1000000000 ;;
  esac
  case $name in million_*) [ "${2:-}" = all ] || continue ;; esac
  divided=$("$program" "$name") || { bad=1 && continue; }
  counted=$(instructions "$program" "$name")
  echo "$name: $counted instructions, $divided"
  [ -n "$counted" ] && [ "$counted" -le "$most" ] || { echo "$name may take $most" && bad=1; }
done
exit "$bad"
