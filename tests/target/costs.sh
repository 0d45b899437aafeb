#!/bin/sh
# costs.sh CONF print   what every scene costs on a target, by running its images of costs.cpp in the emulator
# costs.sh CONF write   the same, into the target's page of docs/measurements
# costs.sh CONF check   fails when a figure has grown by more than 2 % over that page, or is there and measured no more; last line:
#                       "N passed, M failed". With another compiler or emulator than recorded there it compares no figures, but tells
#                       how they differ, and unless it fails, its exit status is 77, "skipped"
#
# CONF is costs.conf in the build's tests/target. A figure that grew for a good reason is renewed by
# `cmake --build --preset PRESET --target write_costs` and committed.
set -eu
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
conf=$1
# shellcheck disable=SC1090  # made by CMake
. "$1"
: "${title:?}" "${compiler:?}" "${size:?}" "${emulator:?}" "${build_type:?}" "${images:?}" "${engines:?}" "${page:?}"
what=$2

# section_bytes ENGINE PATTERN: bytes of the library's sections whose names match.
section_bytes() { "$size" -A "$images/lib$1.a" | awk -v pattern="$2" '$1 ~ pattern { sum += $2 } END { print sum + 0 }'; }

row() {
  log=$images/costs_$1.txt
  eval "$emulator \"\$images/costs_\$1\"" </dev/null >"$log" 2>&1 || { cat "$log" >&2 && return 1; }  # a command with its arguments, each quoted
  stack=$(find "$images" -path "*/$1.dir/*.ci" -exec awk -v root='::step[(]' -f "$here/worst_stack.awk" {} +) || return 1
  bound=$("$here/any_input.sh" "$conf" "$images/costs_$1" "$log") || return 1
  awk -v scene="${1%_*}" -v tick="${1##*_}" -v code="$(section_bytes "$1" '^\\.text')" \
    -v tables="$(section_bytes "$1" '^\\.(s?rodata|data\\.rel\\.ro)')" -v stack="$stack" -v bound="$bound" '
    { sub(/\r$/, "") }
    $1 == "instructions" { mean[$2] = $3; worst[$2] = $4 }
    $1 == "hostile" { hostile = $2 }
    $1 == "ram" { ram = $2 }
    $1 == "painted_stack" { painted = $2 }
    $1 == "faults" { print scene " sets fault bits: " $2 > "/dev/stderr"; bad = 1 }
    END {
      if (painted + 0 > stack + 0) { print scene ": painting finds more stack than the call graph" > "/dev/stderr"; bad = 1 }
      most = hostile + 0
      for (speed in worst) if (worst[speed] + 0 > most) most = worst[speed] + 0
      if (bound != "-" && most > bound + 0) { print scene ": took " most " instructions, more than its bound of " bound > "/dev/stderr"; bad = 1 }
      if (bad || !("redline" in worst) || hostile == "" || painted == "") exit 1
      print "| " scene " | " tick + 0 " | " mean["idle"] " / " worst["idle"] " | " mean["rated"] " / " worst["rated"] " | " mean["redline"] " / " \
        worst["redline"] " | " hostile " | " bound " | " code " | " tables " | " ram " | " stack " | " painted " |"
    }' "$log"
}

# The compiler and the emulator that the figures hold for.
# shellcheck disable=SC2119,SC2120  # the arguments are those that eval sets
versions() {
  eval "set -- $emulator"
  for word in "$@"; do
    case $word in *qemu-*) qemu=$word ;; esac
  done
  printf '%s %s %s; %s\n' "$(basename "$compiler")" "$("$compiler" -dumpfullversion)" "$build_type" "$("$qemu" --version | head -n 1)"
}

print_costs() {
  echo "# $title"
  echo
  echo "Written by tests/target/costs.sh; [performance.md](../performance.md#on-targets) has what the columns mean."
  echo
  echo "$(versions)."
  echo
  echo "| scene | tick, us | idle, mean / worst | rated, mean / worst | redline, mean / worst | hostile | bound, any input | code | tables | RAM | stack, bound | stack, painted |"
  echo "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"
  for engine in $engines; do row "$engine"; done
}

measured=$images/costs.md
print_costs >"$measured"

case $what in
  print) cat "$measured" ;;
  write) cp "$measured" "$page" ;;
  check)
    committed=$page
    [ -f "$page" ] || committed=/dev/null  # a new target has none yet
    awk -v committed_page="$committed" -v page="$page" -v versions="$(versions)." '
      # Rows by scene and tick; the figures of both files in the same order.
      { file = FILENAME == committed_page ? 1 : 2 }
      file == 1 && $0 == versions { same_versions = 1 }
      /^\| [A-Z]/ {
        split($0, cell, " *[|] *")
        key = cell[2] ", " cell[3] " us"
        line = $0
        sub(/^\| [^|]*\|[^|]*\|/, "", line)
        gsub(/[|\/]/, " ", line)
        if (file == 1) { committed[key] = line; next }
        if (!(key in committed)) { print key ": not in the committed table"; ++failed; next }
        before_count = split(committed[key], before, " ")
        now_count = split(line, now, " ")
        delete committed[key]
        gone = grown = ""
        if (now_count != before_count) gone = " " before_count " figures -> " now_count
        for (i = 1; i <= now_count; ++i) {
          if (now[i] == "-" && before[i] != "-") gone = gone " " before[i] " -> none"
          else if (now[i] > before[i] * 1.02) grown = grown " " before[i] " -> " now[i]
        }
        if (gone grown != "") print key ":" gone grown
        if (gone != "" || (grown != "" && same_versions)) ++failed
        else if (same_versions) ++passed
        else ++not_compared
      }
      END {
        for (key in committed) { print key ": committed, but measured no more"; ++failed }
        if (not_compared) print not_compared " rows not compared: " page " records another compiler or emulator than " versions
        print passed + 0 " passed, " failed + 0 " failed"
        exit (failed ? 1 : not_compared ? 77 : !passed)
      }' "$committed" "$measured"
    ;;
  *) sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$0" >&2 && exit 2 ;;
esac
