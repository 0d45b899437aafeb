#!/bin/sh
# any_input.sh CONF IMAGE LOG: the most instructions that a step of an image's engine takes with its call, whatever
# input and state; "-" on processors whose code worst_tick does not read. After that, on processors whose cycles it
# knows, the most cycles of the step at zero wait states and at 5. From the machine code of the image, the limits
# of the engine that it has printed into LOG, and loop_bounds.conf. CONF is costs.conf in the build's tests/target.
set -eu
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
# shellcheck disable=SC1090  # made by CMake
. "$1"
: "${size:?}" "${cycles_of:=}"
image=$2
[ -n "${worst_tick:-}" ] || { echo - && exit; }

"${size%size}objdump" -d --no-show-raw-insn "$image" >"$image.listing"
sed -n 's/^ *\([0-9a-f]*\):	.*/\1/p' "$image.listing" | "${size%size}addr2line" -a -i -e "$image" >"$image.places"
tr -d '\r' <"$3" >"$image.limits"
# shellcheck disable=SC2086  # no word where no cycles are known
bounds=$("$worst_tick" "$image.listing" "$image.places" "$image.limits" "$here/loop_bounds.conf" '6EngineI*4stepE' $cycles_of)
instructions=${bounds%% *}
# The call besides, with what stands between the readings of the counter: two addresses, a branch, at times a copy. And
# one by which the counter may err, since the bound is compared with what it says.
echo "$((instructions + 4 + 1))${bounds#"$instructions"}"
