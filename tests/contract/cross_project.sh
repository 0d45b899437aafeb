#!/bin/sh
# cross_project.sh CODE ENGINES WORK (PREFIX | --source CHECKOUT)
# The firmware of docs/how_to.md, extracted to CODE, for a Cortex-M4F: by find_package from an install of the building
# machine and nothing else, or with the checkout as a subdirectory, which makes its own table maker.
set -eu
code=$1 engines=$2 work=$3
fail() { echo "$*" >&2 && exit 1; }
if ! command -v arm-none-eabi-g++ >/dev/null; then
  echo "no arm-none-eabi-g++"
  exit 77
fi

rm -rf "$work"
mkdir -p "$work"
cp "$code/CMakeLists.txt" "$code/your_board.cmake" "$code/firmware.cpp" "$code/edges_scene.hpp" "$engines/diesel_495.ini" "$work"
if [ "$4" = --source ]; then
  where=-UCRANKLOOP_PROGRAM
  sed "s|^find_package(.*|add_subdirectory(\"$5\" crankloop)|" "$code/CMakeLists.txt" >"$work/CMakeLists.txt"
else
  where=-Dcrankloop_DIR=$(dirname "$(find "$4" -name crankloopConfig.cmake)")
fi

cmake -S "$work" -B "$work/build" "$where" --toolchain "$work/your_board.cmake" \
  -DCMAKE_BUILD_TYPE=Release >"$work/log" 2>&1 || { cat "$work/log"; fail "the project does not configure"; }
cmake --build "$work/build" --parallel 2 >>"$work/log" 2>&1 ||
  { tail -n 40 "$work/log"; fail "the project does not build"; }
[ ! -e "$work/build/crankloop/core/libcrankloop.a" ] || fail "the library is built for the processor, though nothing links it"
arm-none-eabi-nm -C "$work/build/firmware" >"$work/symbols"
grep -q 'crankloop::Engine<float, EdgesScene>::step' "$work/symbols" || fail "the firmware has no engine"
if arm-none-eabi-objdump -f "$work/build/firmware" | grep -qv "^$\|armv7e-m\|elf32-littlearm\|flags\|HAS_\|EXEC_P\|start address"; then
  fail "the firmware is for another processor"
fi
