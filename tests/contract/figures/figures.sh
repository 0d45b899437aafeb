#!/bin/sh
# The figures of the README, of CHANGELOG.md and of docs/decisions, measured on this machine.
#
#   figures.sh BUILD_DIR errors         largest errors against exact equations: the same everywhere
#   figures.sh BUILD_DIR scenes         flash, RAM, stack, instructions and time of each scene
#   figures.sh BUILD_DIR performance    writes docs/measurements/host.md, and what docs/performance.md says of it
#   figures.sh BUILD_DIR decisions      what docs/decisions/0002 to 0006 state
#   figures.sh BUILD_DIR groups         code, tables, RAM and instructions of groups of results and parts of the gas, one each
#   figures.sh BUILD_DIR check README HOST  whether they state the errors, the RAM and what groups cost that are measured now
#   figures.sh BUILD_DIR                errors and scenes
#
# What the documents show of the program's output: printed.sh.
#
# Builds into BUILD_DIR; CXX names another compiler than c++. Instructions need valgrind, stack needs GCC: else a dash.
set -eu
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
# shellcheck source-path=SCRIPTDIR source=../instructions.sh
. "$here/../instructions.sh"
engine=$here/../../../tools/engines/diesel_495.ini
build_dir=$1
what=${2:-}
here_now=$(pwd)
absolute() { case $1 in /*) echo "$1" ;; *) echo "$here_now/$1" ;; esac; }
jobs=$(nproc 2>/dev/null || echo 1)

mkdir -p "$build_dir"
if ! { cmake -S "$here" -B "$build_dir" -DCMAKE_BUILD_TYPE=Release && cmake --build "$build_dir" --parallel "$jobs"; } >"$build_dir/build.log" 2>&1; then
  tail -n 40 "$build_dir/build.log" >&2
  exit 1
fi
cd "$build_dir"

# ---- scenes ----------------------------------------------------------------------------------------------------------

# section_bytes NAME PATTERN: bytes of the engine's sections whose names match.
section_bytes() { size -A "lib$1.a" | awk -v pattern="$2" '$1 ~ pattern { sum += $2 } END { print sum + 0 }'; }

# Of step and of all that it calls, as if each called the next: at most.
stack_bytes() {
  find . -path "*/$1.dir/*.su" -exec cat {} + |
    awk -F '\t' '!/::(init|restore|output|state|settle)\(|::Engine\(/ { sum += $2 } END { print (sum > 0 ? sum : "-") }'
}

# What 20 000 steps take more than 10 000: start-up and end are in both.
instructions_per_tick() {
  command -v valgrind >/dev/null 2>&1 || { echo - && return; }
  echo $((($(instructions "./ticks_$1" 20000) - $(instructions "./ticks_$1" 10000) + 5000) / 10000))
}

scene_row() {
  # The quickest of five medians: other programs can only slow it down.
  ram_and_time=$(for _ in 1 2 3 4 5; do "./ticks_$2"; done | sort -n -k 2 | head -n 1)
  echo "| $1 | $(section_bytes "$2" '^\\.text') | $(section_bytes "$2" '^\\.(rodata|data\\.rel\\.ro)') | ${ram_and_time% *} | $(stack_bytes "$2") |" \
    "$(instructions_per_tick "$2") | ${ram_and_time#* } |"
}

scene_header() {
  echo "| scene, four cylinders of the 495 diesel | code, bytes | tables, bytes | RAM, bytes | stack, bytes | instructions | ns |"
  echo "| --- | --- | --- | --- | --- | --- | --- |"
}

# What the figures are of.
measured_on() {
  compiler=$(sed -n 's/^CMAKE_CXX_COMPILER:[^=]*=//p' CMakeCache.txt | head -n 1)
  echo "$(uname -m), $(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo | head -n 1), $(basename "$compiler") $("$compiler" -dumpfullversion -dumpversion), -O3"
}

scenes() {
  scene_header
  for real in float double; do
    scene_row "mean torque, $real" "TorqueOnly_$real"
    scene_row "torque and mean torque, any load, $real" "TorqueByLoad_$real"
    scene_row "piston motion, $real" "PistonMotion_$real"
    scene_row "mean torque from measured phase and pressures, $real" "TorqueSensor_$real"
    scene_row "motion, forces, torque, $real" "ForcesAndTorque_$real"
    scene_row "engine with gas exchange: throttle, fuel and burn in, torque out, 8 cam-following valves, $real" "Breathing_$real"
    scene_row "everything, $real" "Everything_$real"
    scene_row "everything, up to 16 cylinders, $real" "EverythingUpTo16_$real"
  done
  echo
  echo "$(measured_on), load $(cut -d ' ' -f 1 /proc/loadavg)"
}

# What one group of results or part of the gas takes beside a scene without: scenes of tests/target.
valve_groups='ElasticValves SurgingValves CamContactValves CamTorqueValves'
gas_groups='Fired FiredCrevice FiredBlowBy FiredRunners FiredWalls FiredKnock FiredChargeBurn FiredLambda FiredSensors'
group_ticks=6000  # two cycles at 2000 rpm and 20 us

group_row() {
  count=-
  if command -v valgrind >/dev/null 2>&1; then
    more=$((2 * group_ticks))
    count=$((($(instructions "./ticks_$1" $more) - $(instructions "./ticks_$1" $group_ticks) + group_ticks / 2) / group_ticks))
  fi
  echo "| $1 | $(section_bytes "$1" '^\\.text') | $(section_bytes "$1" '^\\.(rodata|data\\.rel\\.ro)') | $("./ticks_$1" ram) | $count |"
}

groups() {
  echo "| scene, one group each | code, bytes | tables, bytes | RAM, bytes | instructions, 2000 rpm, 20 us |"
  echo "| --- | --- | --- | --- | --- |"
  # shellcheck disable=SC2086  # lists of words
  for group in $valve_groups $gas_groups; do group_row "$group"; done
}

# ---- docs/measurements/host.md ---------------------------------------------------------------------------------------

example_rows() {  # example_rows REAL
  scene_row "piston motion" "PistonMotion_$1"
  scene_row "mean torque" "TorqueOnly_$1"
  scene_row "motion, forces, torque" "ForcesAndTorque_$1"
  scene_row "8 cam-following valves" "ValveLift_$1"
  scene_row "8 elastic valves" "ValveDynamics_$1"
  scene_row "everything, 8 elastic valves, their forces and results" "WholeEngine_$1"
}

# shellcheck disable=SC2016  # code in Markdown
performance() {
  {
    printf '# Scenes on a host\n\nWritten by `tests/contract/figures/figures.sh BUILD_DIR performance`; '
    echo "[performance.md](../performance.md#a-scene) has what the columns mean."
    printf '\nMeasured on: %s.\n\n' "$(measured_on)"
    echo "Float:"
    echo
    scene_header
    example_rows float
    echo
    echo "Double:"
    echo
    scene_header
    example_rows double
    echo
    echo "Groups, float:"
    echo
    groups
  } >host.md
  cp host.md "$here/../../../docs/measurements/host.md"
  "$here/performance.sh" "$here/../../.." renew
}

# ---- decisions -------------------------------------------------------------------------------------------------------

decisions() {
  for decision in phase curves pressure; do
    echo "==== $decision"
    "./decision_$decision"
  done
  echo "==== mean torque"
  ./decision_mean_torque "$engine"
  echo "==== elementary functions"
  ./decision_elementary
  echo "---- the C library without fused multiply-add (glibc on x86-64)"
  GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2,-AVX512F ./decision_elementary
}

# ---- check -----------------------------------------------------------------------------------------------------------

# states_ram FILE ENGINE...: a row of FILE has each engine's RAM in its fourth column.
states_ram() {
  stating=$1
  shift
  for engine_name in "$@"; do
    ram=$("./ticks_$engine_name" | cut -d ' ' -f 1)
    awk -F '|' -v ram="$ram" '{ gsub(/ /, "", $5) } $5 == ram { found = 1 } END { exit !found }' "$stating" ||
      { echo "no scene of $stating has the $ram bytes of RAM of $engine_name" && bad=$((bad + 1)); }
  done
}

# states_groups HOST MEASURED: no figure of a group has grown by over 2 %. RAM everywhere; code, tables and instructions by the compiler and
# on the kind of processor that HOST names, instructions where they can be counted.
states_groups() {
  same=0
  here_on=$(measured_on | sed 's/, [^,]*, /, /')
  [ "$(sed -n 's/^Measured on: \(.*\)\.$/\1/p' "$1" | sed 's/, [^,]*, /, /')" = "$here_on" ] && same=1
  awk -F ' *[|] *' -v same="$same" -v page="$1" '
    FNR == 1 { groups = 0 }
    /^\| scene, one group each/ { groups = 1; next }
    !groups || $2 !~ /^[A-Z][A-Za-z]*$/ { if (groups && /^$/) groups = 0; next }
    NR == FNR { for (i = 3; i <= 6; ++i) was[$2, i] = $i; told[$2] = 1; next }
    !told[$2] { print "not in " page ": " $0; bad = 1; next }
    {
      delete told[$2]
      for (i = 3; i <= 6; ++i) {
        if ((i != 5 && !same) || $i == "-" || $i + 0 <= was[$2, i] * 1.02) continue
        print page ", " $2 ": " was[$2, i] " has grown to " $i
        bad = 1
      }
    }
    END { for (name in told) if (told[name]) { print page " has a row of " name ", which is no more"; bad = 1 } exit bad }' "$1" "$2"
}

# Every measured row of errors stands in the README, and so does the RAM of every scene that it and
# docs/measurements/host.md name.
check() {
  bad=0
  ./errors "$engine" >errors.txt
  while read -r row; do
    grep -qxF "$row" "$1" || { echo "not in $1: $row" && bad=$((bad + 1)); }
  done <errors.txt
  states_ram "$1" TorqueOnly_float TorqueByLoad_float PistonMotion_float TorqueSensor_float ForcesAndTorque_float Breathing_float Everything_float \
    ValveLift_float ValveDynamics_float WholeEngine_float
  for real in float double; do
    states_ram "$2" "PistonMotion_$real" "TorqueOnly_$real" "ForcesAndTorque_$real" "ValveLift_$real" "ValveDynamics_$real" "WholeEngine_$real"
  done
  groups >groups.md
  # shellcheck disable=SC2015  # the count of what is bad decides
  states_groups "$2" groups.md || bad=$((bad + 1))
  [ "$bad" -eq 0 ]
}

case $what in
  errors) ./errors "$engine" ;;
  scenes) scenes ;;
  decisions) decisions ;;
  groups) groups ;;
  performance) performance ;;
  check) check "$(absolute "$3")" "$(absolute "$4")" ;;
  '')
    ./errors "$engine"
    echo
    scenes
    ;;
  *) sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$0" >&2 && exit 2 ;;
esac
