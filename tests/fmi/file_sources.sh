#!/bin/sh
# file_sources.sh PROGRAM ENGINE FMU_TRACE FOLDER: the sources in the FMU of an engine file compile, with nothing else beside
# them, by the command that they name, though with less optimisation, and give the bits of the binary that the FMU came
# with.
set -eu
program=$1 engine=$2 trace=$3 folder=$4
rm -rf "$folder"
mkdir -p "$folder/unpacked"
"$program" fmu "$engine" --crank torque --real float -o "$folder/engine.fmu"
(cd "$folder/unpacked" && cmake -E tar xf ../engine.fmu)
command=$(sed -n 's/^    g++ /g++ /p' "$folder/unpacked/sources/README.txt")
case $command in *' -O'[23]' '*) ;; *) echo "the command is not optimised: $command" && exit 1 ;; esac
command=$(echo "$command" | sed 's/ -O[23] / -O0 /')
# shellcheck disable=SC2086  # words of a command line
(cd "$folder/unpacked/sources" && $command)
mv "$folder/unpacked/sources/engine.so" "$folder/unpacked/binaries/x86_64-linux/"
"$program" pack "$folder/unpacked" -o "$folder/rebuilt.fmu"
if cmp -s "$folder/engine.fmu" "$folder/rebuilt.fmu"; then echo 'nothing was rebuilt' && exit 1; fi
"$trace" "$folder/engine.fmu" >"$folder/engine.txt"
"$trace" "$folder/rebuilt.fmu" >"$folder/rebuilt.txt"
[ "$(wc -l <"$folder/engine.txt")" -eq 11 ]
diff "$folder/engine.txt" "$folder/rebuilt.txt"
