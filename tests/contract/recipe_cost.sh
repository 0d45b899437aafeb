#!/bin/sh
# recipe_cost.sh PROJECT README_CODE PREFIX COMPILER CHECKOUT WORK
# The README's recipe, configured as printed, without a build type, has the step that its table of costs states; so has a
# Debug build. Only the option that names it makes a slower one.
set -eu
project=$1 code=$2 prefix=$3 compiler=$4 checkout=$5 work=$6
# shellcheck source=instructions.sh
. "$(dirname -- "$0")/instructions.sh"
command -v valgrind >/dev/null 2>&1 || { echo "valgrind is not installed" && exit 77; }
case $(uname -m)-$("$compiler" --version | head -n 1) in
  x86_64-*clang*) percent=200 ;;
  x86_64-*) percent=110 ;;
  *) percent=200 ;;  # the README's table is of g++ on x86-64
esac
stated=$(awk -F '|' '/mean torque: the loop above/ { gsub(/ /, "", $7); print $7 }' "$checkout/README.md")
[ -n "$stated" ] || { echo "README.md states no instructions of its loop" && exit 1; }

# step_of NAME OPTION...: instructions of a step, of what the project's own flags compile none.
step_of() {
  name=$1
  shift
  { cmake -S "$project" -B "$work/$name" "-DCMAKE_PREFIX_PATH=$prefix" "-DCMAKE_CXX_COMPILER=$compiler" \
    "-DCRANKLOOP_SAMPLE_ENGINES=$checkout/tools/engines" "-DEXTRACTED_DIR=$code" "$@" &&
    cmake --build "$work/$name" --target firmware; } >"$work/$name.log" 2>&1 || { tail -n 40 "$work/$name.log" >&2 && return 1; }
  of() { instructions_within '*::step(*' "$work/$name/firmware" "$1"; }
  echo $((($(of 20000) - $(of 10000) + 5000) / 10000))
}

rm -rf "$work"
mkdir -p "$work"
bad=0
as_printed=$(step_of none)
in_debug=$(step_of debug -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS=-gdwarf-4)  # older valgrinds read no 5
slow=$(step_of slow -DCRANKLOOP_SCENE_OPTIMIZATION=-O0)
echo "instructions a step: $as_printed as printed, $in_debug in Debug, $slow with CRANKLOOP_SCENE_OPTIMIZATION=-O0; README: $stated"
for found in "$as_printed" "$in_debug"; do
  if [ "$found" -lt 50 ] || [ "$found" -gt $((stated * percent / 100)) ]; then echo "$found is not about $stated" && bad=1; fi
done
[ "$slow" -gt $((3 * stated)) ] || { echo "the option changes nothing" && bad=1; }
exit $bad
