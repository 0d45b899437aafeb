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
[ -z "${cycles_of:=}" ] || : "${step_cycles:?}"
what=$2
core_mhz=180  # at which cycles are set against the tick

# section_bytes ENGINE PATTERN: bytes of the library's sections whose names match.
section_bytes() { "$size" -A "$images/lib$1.a" | awk -v pattern="$2" '$1 ~ pattern { sum += $2 } END { print sum + 0 }'; }

row() {
  log=$images/costs_$1.txt
  counter=
  if [ -n "$cycles_of" ]; then
    "${size%size}objdump" -d --no-show-raw-insn "$images/costs_$1" >"$images/costs_$1.listing"
    # shellcheck disable=SC2016  # for eval
    counter='-plugin "$step_cycles,listing=$images/costs_$1.listing,root=6EngineI*4stepE"'
  fi
  eval "$emulator \"\$images/costs_\$1\" $counter" </dev/null >"$log" 2>&1 || { cat "$log" >&2 && return 1; }  # a command with its arguments, each quoted
  stack=$(find "$images" -path "*/$1.dir/*.ci" -exec awk -v root='::step[(]' -f "$here/worst_stack.awk" {} +) || return 1
  bounds=$("$here/any_input.sh" "$conf" "$images/costs_$1" "$log") || return 1
  echo "bounds $bounds" >>"$log"
  awk -v scene="${1%_*}" -v tick="${1##*_}" -v code="$(section_bytes "$1" '^\\.text')" \
    -v tables="$(section_bytes "$1" '^\\.(s?rodata|data\\.rel\\.ro)')" -v stack="$stack" -v bound="${bounds%% *}" '
    { sub(/\r$/, "") }
    $1 == "instructions" { mean[$2] = $3; worst[$2] = $4 }
    $1 == "searched" { searched = $2 }
    $1 == "ram" { ram = $2 }
    $1 == "painted_stack" { painted = $2 }
    $1 == "faults" { print scene " sets fault bits: " $2 > "/dev/stderr"; bad = 1 }
    END {
      if (painted + 0 > stack + 0) { print scene ": painting finds more stack than the call graph" > "/dev/stderr"; bad = 1 }
      most = searched + 0
      for (speed in worst) if (worst[speed] + 0 > most) most = worst[speed] + 0
      if (bound != "-" && most > bound + 0) { print scene ": took " most " instructions, more than its bound of " bound > "/dev/stderr"; bad = 1 }
      if (bad || !("redline" in worst) || searched == "" || painted == "") exit 1
      print "| " scene " | " tick + 0 " | " mean["idle"] " / " worst["idle"] " | " mean["rated"] " / " worst["rated"] " | " mean["redline"] " / " \
        worst["redline"] " | " searched " | " bound " | " code " | " tables " | " ram " | " stack " | " painted " |"
    }' "$log"
}

# cycle_row ENGINE COLUMN: from the log that row() has made; COLUMN is that of the means.
cycle_row() {
  awk -v scene="${1%_*}" -v tick="${1##*_}" -v column="$2" -v mhz="$core_mhz" '
    { sub(/\r$/, "") }
    $1 == "cycles" { mean = $column; worst = $(column + 1); instructions = $7; counted = 1 }
    $1 == "instructions" || $1 == "searched" {
      name = $1 == "searched" ? $1 : $2
      off = ($1 == "searched" ? $2 : $4) - instructions  # the call, with what stands between the readings of the counter
      if (!counted || off < 0 || off > 5) { print scene ", " name ": the counts of instructions differ by " off > "/dev/stderr"; bad = 1 }
      if (name == "searched") searched = worst
      else { if (mean > most_mean) most_mean = mean; if (worst > most_worst) most_worst = worst }
      counted = 0
    }
    $1 == "bounds" { instruction_bound = $2; bound = $(column / 2 + 2) }
    END {
      if (most_worst > bound || searched > bound) { print scene ": took more cycles than its bound of " bound > "/dev/stderr"; bad = 1 }
      if (bound < instruction_bound) { print scene ": " bound " cycles are fewer than the instructions" > "/dev/stderr"; bad = 1 }
      if (bad || !most_mean || !searched) exit 1
      share = 100 / (mhz * tick)
      printf "| %s | %d | %d / %d | %d | %d | %.1f / %.1f / %.1f | %d |\n", scene, tick, most_mean, most_worst, searched, bound,
        most_mean * share, most_worst * share, bound * share, int((bound + mhz - 1) / mhz)
    }' "$images/costs_$1.txt"
}

# cycle_table WAIT_STATES COLUMN WHICH: after the rows of all engines.
cycle_table() {
  printf '\nCycles, %s wait states: %s\n\n' "$1" "$3"
  echo "| scene | tick, us | mean / worst | searched | bound, any input | % of the tick at $core_mhz MHz, mean / worst / bound | bound, us at $core_mhz MHz |"
  echo "| --- | --- | --- | --- | --- | --- | --- |"
  for engine in $engines; do cycle_row "$engine" "$2"; done
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
  echo "| scene | tick, us | idle, mean / worst | rated, mean / worst | redline, mean / worst | searched | bound, any input | code | tables | RAM | stack, bound | stack, painted |"
  echo "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"
  for engine in $engines; do row "$engine"; done
  if [ -n "$cycles_of" ]; then
    cycle_table 0 2 "by tests/target/worst_tick/costs.hpp, from the core's manual; mean and worst of the most expensive of the three speeds."
    cycle_table 5 4 "code and tables in a flash that reads 32 bits at a time, without cache and prefetch. Most boards are faster."
  fi
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
      FNR == 1 { unit = "" }
      file == 1 && $0 == versions { same_versions = 1 }
      /^Cycles, / { unit = ", cycles at " $2 " wait states" }
      /^\| [A-Z]/ {
        split($0, cell, " *[|] *")
        key = cell[2] ", " cell[3] " us" unit
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
