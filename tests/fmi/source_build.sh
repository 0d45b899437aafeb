#!/bin/sh
# source_build.sh FMU_FOLDER SCENE PROGRAM FOLDER: the sources in a scene's FMUs compile, with nothing else beside
# them, by the command that they name; FOLDER then has the FMUs with what was compiled in the place of their binary.
set -eu
fmus=$1 scene=$2 program=$3 folder=$4
rm -rf "$folder"
for version in 2 3; do
  one=$folder/$version
  mkdir -p "$one"
  (cd "$one" && cmake -E tar xf "$fmus/${scene}_fmi$version.fmu")
  command=$(sed -n 's/^    g++ /g++ /p' "$one/sources/README.txt")
  # shellcheck disable=SC2086  # words of a command line
  (cd "$one/sources" && $command)
  for place in "$one"/binaries/*; do mv "$one/sources/$scene.so" "$place/"; done
  "$program" pack "$one" -o "$folder/${scene}_fmi$version.fmu"
done
