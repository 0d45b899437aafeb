#!/bin/sh
# headers_compile_alone.sh COMPILER STANDARD INCLUDE_DIR...
# Every public header compiles as the only one included, and included twice, under the warnings that crankloop's own
# builds use. As a standard after C++17 all of them compile together.
set -eu
compiler=$1 standard=$2
shift 2

headers=$(for dir in "$@"; do (cd "$dir" && find crankloop -name '*.hpp' | sort); done)
[ -n "$headers" ] || { echo "no header found in $*" && exit 1; }
for dir in "$@"; do set -- "$@" -I "$dir" && shift; done
set -- "-std=$standard" -fsyntax-only "$@" -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wdouble-promotion -Wshadow -Werror -x c++ -

bad=0
refused() { echo "does not compile as $standard: $1" && bad=$((bad + 1)); }
if [ "$standard" = c++17 ]; then
  for header in $headers; do
    printf '#include <%s>\n#include <%s>\n' "$header" "$header" | "$compiler" "$@" || refused "$header alone"
  done
else
  # shellcheck disable=SC2086  # a list of words
  printf '#include <%s>\n' $headers | "$compiler" "$@" || refused 'all headers together'
fi
echo "$(echo "$headers" | wc -l) headers, $bad bad"
[ "$bad" -eq 0 ]
