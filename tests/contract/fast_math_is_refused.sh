#!/bin/sh
# fast_math_is_refused.sh COMPILER CORE_DIR
# Under flags that give up IEEE arithmetic, a user's source that includes the library is refused with an error that says
# so, and the library itself cannot be built; under ordinary flags both are accepted.
set -eu
compiler=$1 core=$2

# Prints what the compiler says; answers whether it accepts.
accepts() { "$compiler" -std=c++17 -fsyntax-only -I "$core/include" -I "$core/src" "$@" 2>&1; }
includes() { echo '#include <crankloop/crankloop.hpp>' | accepts "$@" -x c++ -; }
fail() {
  echo "$*"
  exit 1
}

for flags in -O0 -O3 -march=native; do
  includes "$flags" || fail "a user's source is refused under $flags"
done
for flags in -ffast-math -Ofast -ffinite-math-only; do
  said=$(includes "$flags") && fail "a user's source is not refused under $flags"
  case $said in
    *"needs IEEE arithmetic"*) ;;
    *) fail "refused under $flags, but for another reason: $said" ;;
  esac
done

# That every source of the library is accepted under ordinary flags, its own build shows; one that refuses is enough to
# end a build.
for source in "$core"/src/tick/*.cpp; do
  accepts "$source" || fail "$source is refused under ordinary flags"
  said=$(accepts -ffast-math "$source") && fail "$source can be built under -ffast-math"
  case $said in
    *"needs IEEE arithmetic"*) exit 0 ;;
    *) fail "$source is refused under -ffast-math, but for another reason: $said" ;;
  esac
done
fail "no source of the tick found in $core/src"
