#!/bin/sh
# c_headers.sh C_COMPILER CXX_COMPILER INCLUDE_DIR...
# Every public C header compiles alone and twice, as C99, C11, C++17 and C++20, under all warnings; and every name in it
# has the prefix: the library's, or FMI's own where a header declares FMI.
set -eu
c_compiler=$1 cxx_compiler=$2
shift 2
bad=0
headers=$(for dir in "$@"; do (cd "$dir" && find crankloop -name '*.h' | sort); done)
[ "$(echo "$headers" | grep -c '_[fd]\.h$')" -eq 4 ] || { echo "not four engines: $headers" && exit 1; }
files=$(for dir in "$@"; do (cd "$dir" && find "$PWD/crankloop" -name '*.h'); done)
for dir in "$@"; do set -- "$@" -I "$dir" && shift; done
for header in $headers; do
  # A declaration too: a header of macros alone leaves a translation unit empty, which ISO C forbids.
  twice=$(printf '#include <%s>\n#include <%s>\nextern int anything;\n' "$header" "$header")
  for standard in c99 c11; do
    echo "$twice" | "$c_compiler" "-std=$standard" -fsyntax-only "$@" -x c - \
      -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wstrict-prototypes -Werror || bad=$((bad + 1))
  done
  for standard in c++17 c++20; do
    echo "$twice" | "$cxx_compiler" "-std=$standard" -fsyntax-only "$@" -x c++ - \
      -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror || bad=$((bad + 1))
  done
  # Functions, types, macros and enumerators, by where they stand.
  names=$(sed -n -e 's/^#define \([A-Za-z_0-9]*\).*/\1/p' -e 's/^} \([A-Za-z_0-9]*\);.*/\1/p' -e 's/^typedef struct \([A-Za-z_0-9]*\).*/\1/p' \
    -e 's/^  \([A-Z][A-Z_0-9]*\)\( = .*\|,.*\|\)$/\1/p' -e 's/^CRANKLOOP_API .*[ *]\([A-Za-z_0-9]*\)(.*/\1/p' "$(echo "$files" | grep "/$header\$")")
  wrong=$(echo "$names" | grep -vE '^((crankloop|CRANKLOOP)_|fmi[23]|$)' || true)
  [ -z "$wrong" ] || { echo "$header: without the prefix: $wrong" && bad=$((bad + 1)); }
done
echo "$(echo "$headers" | wc -l) headers, $bad bad"
[ "$bad" -eq 0 ]
