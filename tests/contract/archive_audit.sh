#!/bin/sh
# archive_audit.sh [--float] ARCHIVE...
# What linking an archive brings with it, and what it does not: asks nothing of the image but memcpy, memset and
# memmove, has no variable, nothing that runs before main, no exception, no RTTI, no guard of a static, no symbol of a
# name that could be a user's, and no fused multiply-add. With --float also no instruction that computes in double.
# Complains of everything it finds.
#
# Instructions are looked at on x86-64 and AArch64, double ones on x86-64.
set -eu
real=any
if [ "$1" = --float ]; then real=float && shift; fi

# The last two are of compilers that are set up to ask for them: position-independent code, and Ubuntu's stack guard.
allowed_undefined='memcpy memset memmove _GLOBAL_OFFSET_TABLE_ __stack_chk_fail'
fused='^(v?fn?m(add|sub)(add|sub)?(132|213|231)?[ps][sdh]|fn?m(add|sub)|fml[as])$'
in_double="^(v?(add|sub|mul|div|sqrt|min|max|cmp[a-z]*|u?comi|round|rndscale|hadd|hsub|addsub|fn?m[a-z]+[0-9]*)[sp]d"
in_double="$in_double|v?cvt[a-z0-9]*[sp]d[a-z0-9]*|f[a-z]+[0-9]*)\$"  # the last: x87, in extended precision

bad=0
complain() {  # complain WHAT LIST: if the list is not empty
  [ -n "$2" ] || return 0
  bad=$((bad + 1))
  printf '%s: %s:\n%s\n' "$archive" "$1" "$2"
}

audit() {
  archive=$1
  name=$(basename "$archive" .a)
  name=${name#lib}
  linked=$archive.audit.o
  ld -r --whole-archive "$archive" -o "$linked"

  undefined=$(nm --undefined-only --format=posix "$linked" | awk '{ print $1 }')
  for symbol in $allowed_undefined; do undefined=$(echo "$undefined" | grep -vx "$symbol" || true); done
  complain 'asks the image for' "$undefined"

  complain 'has sections that firmware must not need' "$(size -A "$linked" |
    awk '$2 > 0 && $1 ~ /^\.(data|bss|tdata|tbss|init_array|preinit_array|fini_array|ctors|dtors|init|fini|gcc_except_table)(\.|$)/ &&
         $1 !~ /^\.data\.rel\.ro/ { print $1, $2 }')"

  symbols=$(nm --format=posix "$linked")
  complain 'has guards of static variables' "$(echo "$symbols" | grep -E '^_ZGV' || true)"
  complain 'has RTTI or virtual tables' "$(echo "$symbols" | grep -E '^_ZT[ISVTC]' || true)"
  complain 'defines names outside its own' "$(nm --defined-only --extern-only --format=posix "$linked" |
    grep -vE "^(_ZZ*NK?(9crankloop|${#name}$name)|crankloop_|${name}_)" || true)"

  instructions=$(objdump -d --no-show-raw-insn "$linked" | awk -F '\t' 'NF > 1 { split($2, word, " "); print word[1] }' | sort -u)
  [ -n "$instructions" ] || complain 'has no code' "$linked"
  complain 'fuses multiply and add' "$(echo "$instructions" | grep -E "$fused" || true)"
  if [ "$real" = float ] && [ "$(uname -m)" = x86_64 ]; then
    complain 'computes in double' "$(echo "$instructions" | grep -E "$in_double" || true)"
  fi
  rm -f "$linked"
}

for archive in "$@"; do audit "$archive"; done
[ "$bad" -eq 0 ]
