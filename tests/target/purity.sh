#!/bin/sh
# purity.sh CONF: what the library part of a firmware must not have: calls of anything but what moves memory, data that
# start-up has to initialise or zero, constructors, exception tables, type information, double arithmetic in a float
# scene. Of every scene that costs.sh measures; the last line says "N passed, M failed". CONF is costs.conf in the
# build's tests/target.
set -eu
# shellcheck disable=SC1090  # made by CMake
. "$1"
: "${size:?}" "${images:?}" "${engines:?}"
nm=${size%size}nm
objdump=${size%size}objdump
passed=0 failed=0

# complain ENGINE WHAT LINES: counts as failed if there are any.
complain() {
  [ -n "$3" ] || return 0
  printf '%s: %s\n%s\n' "$1" "$2" "$3"
  bad=1
}

for engine in $engines; do
  bad=0
  archive=$images/lib$engine.a
  complain "$engine" 'calls from outside' "$("$nm" -u "$archive" | sed -n 's/^ *U //p' | sort -u | grep -vxE 'mem(cpy|set|move)|__aeabi_mem(cpy|set|move|clr)[48]?' || true)"
  complain "$engine" 'sections that a firmware must not have' "$("$size" -A "$archive" |
    awk '$2 > 0 && $1 ~ /^\.(init_array|fini_array|ctors|s?data|s?bss|tdata|tbss|eh_frame|gcc_except_table|ARM\.extab)/ && $1 !~ /^\.data\.rel\.ro/')"
  complain "$engine" 'symbols that a firmware must not have' "$("$nm" -C "$archive" | grep -E ' (typeinfo|vtable|guard variable) ' || true)"
  # Double-precision instructions: Arm's end in .f64, RISC-V's have .d.
  case $engine in
    *_double_*) ;;
    *)
      complain "$engine" 'double arithmetic' "$("$objdump" -d --no-show-raw-insn "$archive" | grep -E '[[:space:]]v[a-z]+\.(f64|f32\.f64|f64\.[a-z0-9]+)[[:space:]]|[[:space:]]f[a-z]+(\.[a-z]+)?\.d[[:space:].]' | head -n 3 || true)"
      ;;
  esac
  if [ "$bad" = 0 ]; then passed=$((passed + 1)); else failed=$((failed + 1)); fi
done
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
