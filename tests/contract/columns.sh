#!/bin/sh
# columns.sh CHECKOUT: no line of C or C++ is longer than 120 columns.
#
# Exceptions are the list of the engine file's keys, one key a line, and code of an earlier README.
set -eu
cd "$1"
long=$(find core port tests tools -type f \( -name '*.[hc]' -o -name '*.[hc]pp' -o -name '*.in[cl]' -o -name '*.in' \) \
  ! -name engine_file_key_list.hpp ! -path "tests/contract/upgrading/*" -exec awk 'length > 120 { print FILENAME ":" FNR ": " length " columns" }' {} +)
[ -z "$long" ] || { echo "$long"; exit 1; }
