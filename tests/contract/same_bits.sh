#!/bin/sh
# same_bits.sh BUILD_DIR [all]: builds tables and tick with two compilers and flags that a user should not set, and with
# `all` at every optimisation too, and compares what they answer: each scene's golden run by its hash
# (same_bits/main.cpp), the tables as the program prints them. Prints a line for each build, and "N passed, M failed"
# last. The first build is what the others are compared with.
set -eu
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
engines=$here/../../tools/engines
mkdir -p "$1"
out=$(CDPATH='' cd -- "$1" && pwd)
jobs=$(nproc 2>/dev/null || echo 1)
passed=0 failed=0

# build_and_run NAME COMPILER FLAGS: leaves what it answers in NAME.txt.
build_and_run() {
  cmake -S "$here/same_bits" -B "$out/$1" -DCMAKE_BUILD_TYPE=None "-DCMAKE_CXX_COMPILER=$2" -DCMAKE_CXX_FLAGS=-O1 -DCRANKLOOP_SCENE_OPTIMIZATION=project "-DSAME_BITS_FLAGS=$(echo "$3" | tr ' ' ';')" &&
    cmake --build "$out/$1" --parallel "$jobs" &&
    "$out/$1/same_bits" "$engines"/*.ini >"$out/$1.txt" || return 1
  for engine in "$engines"/*.ini; do
    for real in float double; do
      for integrator in rk4 exponential; do
        "$out/$1/crankloop/bin/crankloop_table_maker" tables "$engine" --tick-us 100 --real $real --integrator $integrator >"$out/$1.tables" &&
          cksum <"$out/$1.tables" >>"$out/$1.txt" || return 1
      done
    done
  done
}

try() {
  if ! build_and_run "$@" >"$out/$1.log" 2>&1; then
    verdict='does not build or run' failed=$((failed + 1))
    tail -n 30 "$out/$1.log"
  elif [ ! -e "$out/reference.txt" ]; then
    cp "$out/$1.txt" "$out/reference.txt"
    cat "$out/reference.txt"
    verdict='is the reference' passed=$((passed + 1))
  elif cmp "$out/reference.txt" "$out/$1.txt"; then
    verdict='same bits' passed=$((passed + 1))
  else
    verdict='OTHER BITS' failed=$((failed + 1))
    diff "$out/reference.txt" "$out/$1.txt" || true
  fi
  printf '%s %s: %s\n' "$2" "$3" "$verdict"
}

rm -f "$out"/*.txt
# The house flags come after the user's, so these do no harm to the library and its scenes.
try gcc-unsafe g++ '-O3 -march=native -funsafe-math-optimizations -ffp-contract=fast'
try clang-unsafe clang++ '-O3 -march=native -funsafe-math-optimizations -ffp-contract=fast'
if [ "${2-}" = all ]; then
  try gcc-O0 g++ '-O0'
  try gcc-O2 g++ '-O2'
  try gcc-O3 g++ '-O3'
  try gcc-lto g++ '-O2 -march=native -flto'
  try clang-O0 clang++ '-O0'
  try clang-O2 clang++ '-O2'
fi

printf '%s passed, %s failed\n' "$passed" "$failed"
[ "$failed" -eq 0 ]
