#!/bin/sh
# asserts_agree.sh COMPILER CORE_DIR
# Two sources of one binary, one with assertions and one without, do not link; two of a kind do. Without, no symbol of
# theirs is in the object but the one that says so.
set -eu
compiler=$1 core=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

fail() {
  echo "$*"
  exit 1
}
printf '#include <crankloop/phase.hpp>\nint other();\nint main() { return other(); }\n' >"$folder/main.cpp"
printf '#include <crankloop/phase.hpp>\nint other() { return 0; }\n' >"$folder/other.cpp"
for value in 0 1; do
  for name in main other; do
    "$compiler" -std=c++17 -O2 -I "$core/include" -DCRANKLOOP_ASSERTS=$value -c "$folder/$name.cpp" -o "$folder/$name$value.o"
  done
done
for value in 0 1; do
  "$compiler" "$folder/main$value.o" "$folder/other$value.o" -o "$folder/program" || fail "two of value $value do not link"
  other=$((1 - value))
  said=$("$compiler" "$folder/main$value.o" "$folder/other$other.o" -o "$folder/program" 2>&1) && fail "value $value links with $other"
  case $said in
    *crankloop_asserts*) ;;
    *) fail "value $value does not link with $other, but for another reason: $said" ;;
  esac
done
nm -C "$folder/main0.o" | grep -i assert | grep -v ' a crankloop_asserts$\| A crankloop_asserts$' && fail "without assertions there are symbols of them"
exit 0
