#!/bin/sh
# columns.sh CHECKOUT: no line of C or C++ is longer than 120 columns.
#
# The one exception is the list of the engine file's keys, one key a line.
set -eu
cd "$1"
long=$(find core port tests tools -type f \( -name '*.[hc]' -o -name '*.[hc]pp' -o -name '*.in[cl]' -o -name '*.in' \) \
  ! -name engine_file_keys.cpp -exec awk 'length > 120 { print FILENAME ":" FNR ": " length " columns" }' {} +)
[ -z "$long" ] || { echo "$long"; exit 1; }
