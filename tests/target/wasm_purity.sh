#!/bin/sh
# wasm_purity.sh TOOLS ARCHIVE...: what purity.sh demands of a firmware's library part, of WebAssembly objects: imports of
# nothing but what moves memory, data that is constant alone, nothing that runs before main, no exceptions, no type
# information, no double arithmetic in a float scene. TOOLS: LLVM's, such as /usr/lib/llvm-14/bin. The last line says "N
# passed, M failed".
set -eu
tools=$1
shift
passed=0 failed=0

complain() {  # complain ARCHIVE WHAT LINES: counts as failed if there are any
  [ -n "$3" ] || return 0
  printf '%s: %s\n%s\n' "$1" "$2" "$3"
  bad=1
}

for archive in "$@"; do
  bad=0
  complain "$archive" 'imports' "$("$tools/llvm-nm" -u "$archive" | sed -n 's/^ *U //p' | sort -u | grep -vxE 'mem(cpy|set|move)|__stack_pointer' || true)"
  data=$("$tools/llvm-readobj" --sections "$archive" | sed -n 's/^ *Name: \(\..*\)/\1/p' | sort -u)
  complain "$archive" 'data that is not constant, or runs' "$(echo "$data" | grep -vE '^\.rodata|^$' || true)"
  complain "$archive" 'symbols that it must not have' "$("$tools/llvm-nm" -C "$archive" | grep -E ' (typeinfo|vtable|guard variable) |__cxa|__cpp_exception' || true)"
  code=$("$tools/llvm-objdump" -d --no-show-raw-insn "$archive" | awk -F '\t' 'NF > 1 { split($2, word, " "); print word[1] }' | sort -u)
  complain "$archive" 'has no code' "$(echo "$code" | grep -q 'f32\|f64' || echo 'not one instruction of floats')"
  case $archive in
    *_double.a) ;;
    *) complain "$archive" 'double arithmetic' "$(echo "$code" | grep -E '^f64(x2)?\.(add|sub|mul|div|sqrt|promote|convert)' || true)" ;;
  esac
  if [ "$bad" = 0 ]; then passed=$((passed + 1)); else failed=$((failed + 1)); fi
done
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
