#!/bin/sh
# What of the benchmark is committed: a gate that no noisy clock moves, of instructions and errors; and what
# docs/measurements/benchmark.md says of it.
#
#   bench.sh BUILD_DIR check   fails when a kernel takes over 2 % more instructions than instructions.txt says, or an error has grown by
#                              over 2 % from errors.csv; last line: "N passed, M failed"
#   bench.sh BUILD_DIR renew   writes both anew, and into the documents
#   bench.sh BUILD_DIR performance   writes docs/measurements/benchmark.md, its diagrams, and what docs/performance.md says of it
#
# Builds the release program into BUILD_DIR; CXX names another compiler than c++. Instructions are compared only where
# compiler and processor family are those of instructions.txt; errors everywhere: they are the same on every machine,
# but for those of the mathematics library.
set -eu
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
# shellcheck source-path=SCRIPTDIR source=../instructions.sh
. "$here/../instructions.sh"
build_dir=$1
what=${2:-}
jobs=$(nproc 2>/dev/null || echo 1)
cycle_ticks=1000  # a cycle of most kernels; of the others two or four, or a part of one
growth_percent=2

mkdir -p "$build_dir"
if ! { cmake -S "$here/../../.." -B "$build_dir" -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE="-O3 -DNDEBUG" -DCRANKLOOP_BENCH_PEERS=ON &&
  cmake --build "$build_dir" --target crankloop_program --parallel "$jobs"; } >"$build_dir/build.log" 2>&1; then
  tail -n 40 "$build_dir/build.log" >&2
  exit 1
fi
crankloop=$build_dir/bin/crankloop

counted_with() {
  compiler=$(sed -n 's/^CMAKE_CXX_COMPILER:[^=]*=//p' "$build_dir/CMakeCache.txt" | head -n 1)
  family=$("$compiler" --version | head -n 1 | sed 's/^[^ ]* *//')
  echo "# $family, $(uname -m), -O3"
}

# The program itself says which kernels there are.
kernel_names() { "$crankloop" bench --kernel list 2>&1 | sed -n 's/.*kernels: //p' | tr -d ',' ; }

# Of a tick, to within one: what ten cycles take more than two.
kernel_instructions() {
  short=$(instructions "$crankloop" bench --kernel "$1" --ticks $((2 * cycle_ticks)))
  long=$(instructions "$crankloop" bench --kernel "$1" --ticks $((10 * cycle_ticks)))
  echo $(((long - short + 4 * cycle_ticks) / (8 * cycle_ticks)))
}

count_all() {
  counted_with
  for kernel in $(kernel_names); do echo "$kernel $(kernel_instructions "$kernel")"; done
}

# Of what is this project's own: libm's errors are the system's, other solvers theirs.
errors() { "$crankloop" bench --errors --csv - 2>/dev/null | awk -F , '$2 !~ /^(libm|odeint|GSL)/' | cut -d , -f 1-4,8,9; }

# Tells every kernel that takes more, and every one that is new or gone.
compare_instructions() {
  awk -v percent="$growth_percent" '
    /^#/ { next }
    NR == FNR { committed[$1] = $2; next }
    !($1 in committed) { print $1 " is not in instructions.txt"; bad = 1; next }
    { seen[$1] = 1 }
    $2 > committed[$1] * (1 + percent / 100) { print $1 " takes " $2 " instructions a tick, " committed[$1] " were committed"; bad = 1 }
    $2 < committed[$1] * (1 - percent / 100) { print "(" $1 " takes " $2 " instead of " committed[$1] ": bench.sh BUILD_DIR renew keeps it)" }
    END { for (name in committed) if (!(name in seen)) { print name " is gone"; bad = 1 } exit bad }' "$here/instructions.txt" "$1"
}

compare_errors() {
  awk -F , -v percent="$growth_percent" '
    { name = $1 "," $2 "," $3 "," $4 }
    NR == FNR { committed[name] = $5; next }
    !(name in committed) { print name " is not in errors.csv"; bad = 1; next }
    { seen[name] = 1 }
    $5 == "" && committed[name] != "" || $5 + 0 > committed[name] * (1 + percent / 100) {
      if (FNR > 1) { print name " errs by " $5 ", " committed[name] " was committed"; bad = 1 }
    }
    END { for (name in committed) if (!(name in seen)) { print name " is gone"; bad = 1 } exit bad }' "$here/errors.csv" "$1"
}

# What is not compared counts as neither, and has its line "skipped NAME: why".
check() {
  passed=0 failed=0
  errors >"$build_dir/errors.csv"
  if compare_errors "$build_dir/errors.csv"; then passed=$((passed + 1)); else failed=$((failed + 1)); fi
  if ! command -v valgrind >/dev/null 2>&1; then
    echo "no valgrind to count instructions with"
    failed=$((failed + 1))
  elif [ "$(counted_with)" != "$(head -n 1 "$here/instructions.txt")" ]; then
    echo "skipped bench.instructions: $(counted_with | cut -c 3-) here, $(head -n 1 "$here/instructions.txt" | cut -c 3-) in instructions.txt"
  elif count_all >"$build_dir/instructions.txt" && compare_instructions "$build_dir/instructions.txt"; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
  fi
  echo "$passed passed, $failed failed"
  [ "$failed" -eq 0 ]
}

# ---- docs/measurements/benchmark.md ----------------------------------------------------------------------------------

# rows CSV HEADING AWK_CONDITION: contestant, real, setting, time, error.
rows() {
  echo "| $2 | real | setting | ns | error |"
  echo "| --- | --- | --- | --- | --- |"
  awk -F , "$3"' { printf "| %s | %s | %s | %.4g | %.2g %s |\n", $2, $3, $4, $6, $8, $9 }' "$1" | tr ';' ','
}

# distributions CSV: of the groups whose rows come by four: mean, median, 99.9 %, worst.
distributions() {
  echo "| whole tick | real | setting | mean, ns | median | 99.9 % | worst | error |"
  echo "| --- | --- | --- | --- | --- | --- | --- | --- |"
  awk -F , '$1 == "tick" {
    n = n % 4 + 1
    ns[n] = $6
    if (n == 1) { name = $2; real = $3; setting = $4; error = sprintf("%.2g %s", $8, $9) }
    if (n == 4) printf "| %s | %s | %s | %.4g | %.3g | %.3g | %.3g | %s |\n", name, real, setting, ns[1], ns[2], ns[3], ns[4], error
  }' "$1" | tr ';' ','
}

kernels() {
  echo "| kernel | instructions per tick |"
  echo "| --- | --- |"
  awk '!/^#/ { print "| " $1 " | " $2 " |" }' "$here/instructions.txt"
}

# shellcheck disable=SC2016  # fields of awk
performance() {
  csv=$build_dir/bench.csv
  checkout=$here/../../..
  "$crankloop" bench --csv "$csv" --plot "$checkout/docs/images/bench.svg" >"$build_dir/bench.txt"
  {
    echo "# Run time against error"
    printf '\nWritten by `tests/contract/bench/bench.sh BUILD_DIR performance`; '
    echo "[performance.md](../performance.md#beside-plain-code) has what is compared and how."
    printf '\n![Work-precision diagrams](../images/bench.svg)\n'
    printf '\nMeasured on: %s.\n\n' "$(sed -n '1s/^# //p' "$build_dir/bench.txt")"
    rows "$csv" "x, v and a of a piston" '$1 == "kinematics"'
    echo && rows "$csv" "one valve, a cam cycle" '$1 == "valve" && ($4 ~ /; (1|10|20|100) us(; tolerance.*)?$/)'
    echo && distributions "$csv"
    echo && rows "$csv" "a longer tick" '$1 == "growth"'
    echo && rows "$csv" "more and more outputs" '$1 == "skips"'
    echo && echo "Instructions, counted by valgrind; $(head -n 1 "$here/instructions.txt" | cut -c 3-):"
    echo && kernels
  } >"$build_dir/benchmark.md"
  cp "$build_dir/benchmark.md" "$checkout/docs/measurements/benchmark.md"
  "$here/../figures/performance.sh" "$checkout" renew
}

case $what in
  check) check ;;
  performance) performance ;;
  renew)
    errors >"$build_dir/errors.csv" && cp "$build_dir/errors.csv" "$here/errors.csv"
    count_all >"$build_dir/instructions.txt" && cp "$build_dir/instructions.txt" "$here/instructions.txt"
    [ ! -e "$here/../figures/performance.sh" ] || "$here/../figures/performance.sh" "$here/../../.." renew
    ;;
  *) sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$0" >&2 && exit 2 ;;
esac
