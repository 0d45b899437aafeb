#!/bin/sh
# numerical_sanitizer.sh
# The tick, without lanes, under the numerical sanitizer of clang 19 (-fsanitize=numerical), which computes each float
# in double too: prints the lines where the two part by more than 2^-10 of the number, with the largest share of it that
# was seen there. Needs build/release/core/libcrankloop.a, clang++-19, llvm-symbolizer.
set -eu
CDPATH='' cd -- "$(dirname -- "$0")/.."
folder=build/numerical
mkdir -p "$folder"
# Tables come from the library, without a double beside them: the tick takes them as exact.
clang++-19 -std=c++17 -O1 -g -ffp-contract=off -DCRANKLOOP_ABREAST=0 -fsanitize=numerical -I core/include -I core/src -I tests -I tools \
  tests/numerical_sanitizer.cpp build/release/core/libcrankloop.a -lgtest -o "$folder/engine"
NSAN_SYMBOLIZER_PATH=$(command -v llvm-symbolizer)
export NSAN_SYMBOLIZER_PATH
export NSAN_OPTIONS='halt_on_error=0:log2_max_relative_diff=10:disable_warnings=1:enable_warning_stats=1:print_stats_on_exit=1'
"$folder/engine" >"$folder/findings" 2>&1
# Of each finding the first place that is the tick's and no wrapped instruction.
awk '
/^warned / { percent = ""; if (!/ fcmp / && match($0, /error: [0-9.]+%/)) percent = substr($0, RSTART + 7, RLENGTH - 8); next }
percent != "" && match($0, /\/core\/include\/crankloop\/tick\/[a-z_\/]*\.hpp:[0-9]*/) {
  place = substr($0, RSTART + 24, RLENGTH - 24)
  if (place ~ /lanes\.hpp|one_instruction\.hpp/) next
  if (percent + 0 >= largest[place] + 0) largest[place] = percent
  percent = ""
}
END { for (place in largest) print largest[place], place }' "$folder/findings" | sort -k1,1nr >"$folder/lines"
[ -s "$folder/lines" ]
while read -r percent place; do
  # shellcheck disable=SC2016  # backquotes are Markdown
  printf -- '- %s, %s %%: `%s`\n' "$place" "$percent" "$(sed -n "${place#*:}s/^ *//p" "core/include/crankloop/${place%:*}")"
done <"$folder/lines"
