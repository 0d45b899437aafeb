#!/bin/sh
# unzip.sh FMU_FOLDER PROGRAM ENGINES FOLDER: another hand's reader of archives, Info-ZIP's, accepts every FMU of the scenes
# and of the sample engines, and refuses one with a changed byte. Skipped where it is not installed.
set -eu
fmus=$1 program=$2 engines=$3 folder=$4
command -v unzip >/dev/null || { echo 'there is no unzip' && exit 77; }
rm -rf "$folder"
mkdir -p "$folder"
for engine in "$engines"/*.ini; do
  name=$(basename "$engine" .ini)
  "$program" fmu "$engine" -o "$folder/${name}_fmi3.fmu"
  "$program" fmu "$engine" --fmi 2 -o "$folder/${name}_fmi2.fmu"
done
tested=0
for fmu in "$fmus"/*_fmi[23].fmu "$folder"/*.fmu; do
  unzip -tqq "$fmu"
  tested=$((tested + 1))
done
echo "$tested FMUs"
[ "$tested" -ge 28 ]  # nine scenes and five engines, of both versions

cp "$folder/diesel_495_fmi3.fmu" "$folder/damaged.fmu"
printf '!' | dd of="$folder/damaged.fmu" bs=1 seek=5000 conv=notrunc 2>/dev/null
if unzip -tqq "$folder/damaged.fmu" 2>/dev/null; then echo 'a damaged one is accepted' && exit 1; fi
