#!/bin/sh
# example_cycles.sh CONF IMAGE HEADER check   fails when the cycles of the example's steps are off those in HEADER by more
#                                             than 2 %; with another compiler than recorded there its exit status is 77
# example_cycles.sh CONF IMAGE HEADER write   writes them into HEADER
#
# CONF is costs.conf in the build's tests/target.
set -eu
# shellcheck disable=SC1090  # made by CMake
. "$1"
: "${compiler:?}" "${size:?}" "${emulator:?}" "${build_type:?}" "${step_cycles:?}"
image=$2
header=$3
what=$4

"${size%size}objdump" -d --no-show-raw-insn "$image" >"$image.listing"
# An instruction takes 4 ns, as in target.example.
at_250_mips=$(printf '%s\n' "$emulator" | sed 's/shift=[0-9]*/shift=2/')
eval "$at_250_mips \"\$image\" -plugin \"\$step_cycles,listing=\$image.listing,root=6EngineI*4stepE\"" </dev/null >"$image.txt" 2>&1 ||
  { cat "$image.txt" >&2 && exit 1; }
measured=$(tr -d '\r' <"$image.txt" | sed -n 's/^cycles //p')
# shellcheck disable=SC2086  # words
set -- $measured
[ $# -ge 4 ] || { echo "$image: no cycles were counted" >&2 && exit 1; }

by="// $(basename "$compiler") $("$compiler" -dumpfullversion) $build_type"
lines="$by
constexpr ModelCycles kModelCycles{$1, $2};
constexpr ModelCycles kModelCyclesAt5{$3, $4};"
case $what in
  write)
    kept=$(sed -n '1,/^};/p' "$header")
    printf '%s\n%s\n' "$kept" "$lines" >"$header"
    ;;
  check)
    grep -qxF "$by" "$header" || { echo "not compared: $header was written with another compiler than ${by#// }" && exit 77; }
    { cat "$header" && printf '%s\n' "$lines"; } | awk -F '[{, }]+' '
      /^constexpr/ && !($2 " " $3 in mean) { mean[$2 " " $3] = $4; worst[$2 " " $3] = $5; next }
      /^constexpr/ {
        for (f = 4; f <= 5; ++f) {
          before = f == 4 ? mean[$2 " " $3] : worst[$2 " " $3]
          if ($f > before * 1.02 || $f < before * 0.98) { print $3 ": " before " -> " $f; ++failed } else ++passed
        }
      }
      END { print passed + 0 " passed, " failed + 0 " failed"; exit failed || !passed }'
    ;;
  *) sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$0" >&2 && exit 2 ;;
esac
