#!/bin/sh
# firmware_in_qemu.sh README_CODE HOW_TO_CODE HOW_TO ENGINES PREFIX WORK
# "Your firmware under QEMU" of docs/how_to.md: its commands, on the files that it and the README print and an install in
# the home folder, print what it prints. A processor that is too slow counts overruns.
set -eu
readme_code=$1 code=$2 how_to=$3 engines=$4 prefix=$5 work=$6
fail() { echo "docs/how_to.md, firmware under QEMU: $*" >&2 && exit 1; }
for tool in arm-none-eabi-g++ qemu-system-arm; do
  command -v "$tool" >/dev/null || { echo "no $tool" && exit 77; }
done

rm -rf "$work"
mkdir -p "$work/home" "$work/project"
ln -s "$prefix" "$work/home/crankloop"
cp "$readme_code/CMakeLists.txt" "$readme_code/my_scene.hpp" "$readme_code/main.cpp" "$readme_code/bench.cpp" "$work/project"
cp "$code/qemu.cmake" "$code/board.hpp" "$code/board.cpp" "$work/project"
cp "$engines/diesel_495.ini" "$work/project/my_engine.ini"

# The blocks of a kind in the section: ```sh, or ``` alone.
block() {
  awk -v kind="$1" '/^## / { here = $0 == "## Your firmware under QEMU" }
    here && /^```/ { if (inside) { inside = 0; show = 0 } else { inside = 1; show = $0 == kind }; next } show' "$how_to"
}
block '```sh' >"$work/commands"
block '```' >"$work/expected"
grep -q qemu-system-arm "$work/commands" || fail "no commands"

cd "$work/project"
HOME=$work/home timeout 300 sh -eu "$work/commands" >"$work/printed" 2>"$work/errors" ||
  { cat "$work/printed" "$work/errors" && fail "a command failed"; }
grep -E ' ticks, |^overruns ' "$work/printed" "$work/errors" -h | cmp - "$work/expected" || fail "prints $(tail -n 3 "$work/printed" "$work/errors")"

slow=$(sed -n 's/shift=5/shift=9/; /^qemu-system-arm/p' "$work/commands")
status=0
timeout 120 sh -c "$slow" >"$work/slow" 2>&1 || status=$?
[ "$status" -eq 1 ] && grep -q '^overruns [1-9]' "$work/slow" || fail "a slow processor ends with $status: $(cat "$work/slow")"
