#!/bin/sh
# headers_compile_alone.sh COMPILER STANDARD INCLUDE_DIR...
# Every public header compiles as the only one included, and included twice, under the warnings that crankloop's own
# builds use.
set -eu
compiler=$1 standard=$2
shift 2

headers=$(for dir in "$@"; do (cd "$dir" && find crankloop -name '*.hpp' | sort); done)
[ -n "$headers" ] || { echo "no header found in $*" && exit 1; }
for dir in "$@"; do set -- "$@" -I "$dir" && shift; done

bad=0
for header in $headers; do
  printf '#include <%s>\n#include <%s>\n' "$header" "$header" |
    "$compiler" "-std=$standard" -fsyntax-only "$@" -x c++ - \
      -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wdouble-promotion -Wshadow -Werror ||
    { echo "does not compile alone: $header" && bad=$((bad + 1)); }
done
echo "$(echo "$headers" | wc -l) headers, $bad bad"
[ "$bad" -eq 0 ]
