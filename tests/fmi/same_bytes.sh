#!/bin/sh
# same_bytes.sh CMAKE COMPILER PREFIX PROGRAM ENGINES FOLDER: FMUs of one scene, built in two folders of different names, by
# users who live in different time zones, have the same bytes.
set -eu
cmake=$1 compiler=$2 prefix=$3 program=$4 engines=$5 folder=$6
here=$(cd "$(dirname "$0")" && pwd)
rm -rf "$folder"
build() {  # NAME TIME_ZONE
  mkdir -p "$folder/$1"
  cp -R "$here" "$folder/$1/tests of FMUs"
  TZ=$2 "$cmake" -S "$folder/$1/tests of FMUs" -B "$folder/$1/build" -DCMAKE_CXX_COMPILER="$compiler" \
    -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$prefix" -DCRANKLOOP_PROGRAM="$program" \
    -DCRANKLOOP_SAMPLE_ENGINES="$engines" >"$folder/$1/log" 2>&1 &&
    TZ=$2 "$cmake" --build "$folder/$1/build" --target four_pistons_fmus >>"$folder/$1/log" 2>&1 ||
    { cat "$folder/$1/log" && exit 1; }
}
build one UTC
sleep 2  # the smallest step of a date in an archive
build 'another, longer' Pacific/Auckland
for version in 2 3; do
  sha256sum "$folder"/*/build/four_pistons_fmi$version.fmu
  cmp "$folder/one/build/four_pistons_fmi$version.fmu" "$folder/another, longer/build/four_pistons_fmi$version.fmu"
done
