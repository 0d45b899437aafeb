#!/bin/sh
# windows.sh PROGRAM LINUX_BUILD WINDOWS_BUILD FOLDER: FMUs that Linux makes, with a binary for Windows beside their own, give
# the same bits and the same saved states on both, by Wine; their Windows binary needs nothing but the system's own
# libraries and shows nothing but FMI's functions; the sources in them compile for Windows and give the same bits again.
#
#   PROGRAM        crankloop, with the objects that `fmu` packs
#   LINUX_BUILD    of this folder, with fmu_trace and the FMUs of trigger_wheels and breathing_free
#   WINDOWS_BUILD  of this folder, with fmu_trace
set -eu
program=$1 linux=$2 windows=$3 folder=$4
here=$(CDPATH='' cd -- "$(dirname "$0")" && pwd)
engines=$here/../../tools/engines
wine=$here/../../port/windows/run.sh
passed=0 failed=0
rm -rf "$folder"
mkdir -p "$folder"

check() {  # WHAT COMMAND...
  what=$1
  shift
  if "$@"; then passed=$((passed + 1)); else
    failed=$((failed + 1))
    echo "FAILED: $what"
  fi
}

# The binary's exports and needs.
object_is_clean() {  # DLL
  exported=$(x86_64-w64-mingw32-objdump -p "$1" | sed -n '/Ordinal\/Name Pointer/,/^$/s/^[[:space:]]*\[.*[] ]\([^] ]*\)$/\1/p' |
    grep -v '^Table$')
  [ "$(echo "$exported" | grep -cE '^fmi[23][A-Z]')" -eq 119 ] && [ "$(echo "$exported" | wc -l)" -eq 119 ] &&
    ! x86_64-w64-mingw32-objdump -p "$1" | grep 'DLL Name' | grep -viE ' (KERNEL32|msvcrt|ucrtbase|api-ms-win[a-z0-9-]*)\.dll$'
}

same_bits() {  # FMU
  "$linux/fmu_trace" "$1" >"$folder/linux.txt" || return 1
  "$wine" "$windows/fmu_trace.exe" "$1" >"$folder/wine.txt" || { cat "$folder/wine.txt" && return 1; }
  tr -d '\r' <"$folder/wine.txt" >"$folder/windows.txt"
  [ "$(wc -l <"$folder/linux.txt")" -eq 11 ] && diff "$folder/linux.txt" "$folder/windows.txt"
}

look_at() {  # FMU
  unpacked=$folder/unpacked
  rm -rf "$unpacked"
  mkdir "$unpacked"
  (cd "$unpacked" && cmake -E tar xf "$1")
  check "$1: exports and needs" object_is_clean "$unpacked"/binaries/*win*/*.dll
  check "$1: bits" same_bits "$1"
}

make_fmu() {  # NAME ENGINE OPTION...
  name=$1 engine=$2
  shift 2
  "$program" fmu "$engines/$engine.ini" "$@" -o "$folder/$name.fmu"
  look_at "$folder/$name.fmu"
}
make_fmu diesel diesel_495 --crank torque
make_fmu diesel_2 diesel_495 --crank speed --fmi 2 --real float
make_fmu single ohc_125 --crank speed --tick-us 50 --real float
make_fmu four_2 four_2000 --crank torque --fmi 2
make_fmu four four_2000 --crank speed --real float
for name in trigger_wheels_fmi2 trigger_wheels_fmi3 breathing_free_fmi3; do look_at "$linux/$name.fmu"; done

# From source, as the FMU says.
one=$folder/from_source
mkdir "$one"
(cd "$one" && cmake -E tar xf "$linux/trigger_wheels_fmi3.fmu")
command=$(sed -n 's/^    g++ //p' "$one/sources/README.txt" | sed 's/trigger_wheels[.]so/trigger_wheels.dll/')
# shellcheck disable=SC2086  # words of a command line
(cd "$one/sources" && x86_64-w64-mingw32-g++ -static $command && mv trigger_wheels.dll "$one/binaries/x86_64-windows/")
"$program" pack "$one" -o "$folder/from_source.fmu"
check 'from source: bits' same_bits "$folder/from_source.fmu"

echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
