#!/bin/sh
# numerical_sanitizer.sh
# The tick under the numerical sanitizer of clang 19 (-fsanitize=numerical), which computes each float in double too:
# prints the lines where the two part by more than 2^-10 of the number, and how often. Needs
# build/release/core/libcrankloop.a, clang++-19, llvm-symbolizer.
set -eu
CDPATH='' cd -- "$(dirname -- "$0")/.."
folder=build/numerical
mkdir -p "$folder"
# Tables come from the library, without a double beside them: the tick takes them as exact.
clang++-19 -std=c++17 -O1 -g -ffp-contract=off -fsanitize=numerical -I core/include -I core/src -I tests -I tools tests/numerical_sanitizer.cpp \
  build/release/core/libcrankloop.a -lgtest -o "$folder/engine"
NSAN_SYMBOLIZER_PATH=$(command -v llvm-symbolizer)
export NSAN_SYMBOLIZER_PATH NSAN_OPTIONS='halt_on_error=0:log2_max_relative_diff=10'
"$folder/engine" >"$folder/findings" 2>&1
sed -n 's/^ *#0 .*\/core\/include\/crankloop\/\(tick\/[a-z_]*\.hpp\):\([0-9]*\).*/\1:\2/p' "$folder/findings" | sort | uniq -c | sort -k1,1nr |
  while read -r times place; do
    file=core/include/crankloop/${place%:*}
    # shellcheck disable=SC2016  # backquotes are Markdown
    printf -- '- %s, %s times: `%s`\n' "$place" "$times" "$(sed -n "${place#*:}s/^ *//p" "$file")"
  done
