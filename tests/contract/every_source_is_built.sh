#!/bin/sh
# every_source_is_built.sh CHECKOUT
# Every .cpp of the library, the program and the tests stands in its list of sources: a test that nobody lists would pass
# for ever.
set -eu
cd "$1"

bad=0
# sources_listed FOLDER LISTS BASE PATTERN: every such source in FOLDER is in LISTS, by its path below BASE.
sources_listed() {
  for source in $(find "$1" -name "$4" | sort); do
    # shellcheck disable=SC2086  # words
    grep -qE "(^|[ (/])${source#"$3"/}( |\)|\$)" $2 || { echo "$source is not in $2" && bad=$((bad + 1)); }
  done
}
sources_listed core/src core/CMakeLists.txt core '*.cpp'
sources_listed port/c port/c/CMakeLists.txt port/c '*.cpp'
tools_lists="tools/CMakeLists.txt tools/crankloop/engine_file/sources.cmake"
for part in crankloop lab; do sources_listed tools/$part "$tools_lists" tools '*.cpp'; done
for kind in unit property golden contract; do sources_listed "tests/$kind" tests/CMakeLists.txt "tests/$kind" '*_test.cpp'; done
sources_listed tests/fmi tests/fmi/CMakeLists.txt tests/fmi '*_test.cpp'
[ "$bad" -eq 0 ]
