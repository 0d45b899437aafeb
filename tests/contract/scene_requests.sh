#!/bin/sh
# scene_requests.sh PREFIX COMPILER ENGINES WORK
# What crankloop_add_scene cannot do is refused when CMake configures, or by the compiler, with the words to mend it.
set -eu
prefix=$1 compiler=$2 engines=$3 work=$4
rm -rf "$work"
mkdir -p "$work"
failures=0
languages=CXX

cat >"$work/asks_scene.hpp" <<'HPP'
#pragma once
#include <crankloop/scene.hpp>
struct AsksScene : crankloop::Scene {
  static constexpr auto cylinders = crankloop::exactly<CYLINDERS>;
  static constexpr auto triggers = crankloop::exactly<TRIGGERS>;
  static constexpr auto valves = crankloop::ValveModel::following;
  static constexpr auto trains = crankloop::exactly<TRAINS>;
};
struct Elastic : crankloop::Scene {
  static constexpr auto cylinders = crankloop::exactly<4>;
  static constexpr auto valves = crankloop::ValveModel::elastic;
  static constexpr auto trains = crankloop::exactly<2>;
};
struct Breathes : Elastic {
  static constexpr auto valves = crankloop::ValveModel::following;
  static constexpr auto pressure = crankloop::PressureGiven::by_gas;
};
struct Forces : crankloop::Scene {
  static constexpr auto cylinders = crankloop::exactly<4>;
  static constexpr bool forces = true;
  static constexpr bool rod_inertia = false;
};
HPP
engine_file=$engines/diesel_495.ini
scene=AsksScene

# project NAME OPTION...: configures and builds a project with a scene of that name; what was said goes to said.
project() {
  name=$1
  shift
  rm -rf "$work/build"
  cat >"$work/CMakeLists.txt" <<CMAKE
cmake_minimum_required(VERSION 3.22)
project(asks LANGUAGES $languages)
find_package(crankloop 0.3 REQUIRED)
crankloop_add_scene($name asks_scene.hpp "$engine_file" SCENE $scene)
CMAKE
  { cmake -S "$work" -B "$work/build" "-DCMAKE_PREFIX_PATH=$prefix" "-DCMAKE_CXX_COMPILER=$compiler" "$@" &&
    cmake --build "$work/build"; } >"$work/said" 2>&1
}
refuses() {  # refuses WORDS NAME OPTION...
  words=$1
  shift
  if project "$@"; then
    echo "builds: $* ($scene, $engine_file)"
    failures=$((failures + 1))
  elif ! tr '\n' ' ' <"$work/said" | tr -s ' ' | grep -qF "$words"; then
    echo "$* is not refused with: $words"
    tail -n 20 "$work/said"
    failures=$((failures + 1))
  fi
}
has() { printf '%s' "-DCMAKE_CXX_FLAGS=-DCYLINDERS=$1 -DTRAINS=$2 -DTRIGGERS=$3"; }

if ! project engine "$(has 4 2 2)"; then
  cat "$work/said"
  failures=1
fi
for word in float class co_await std restrict; do refuses "C++ uses '$word' itself" $word "$(has 4 2 2)"; done
refuses "must be an identifier" my-engine "$(has 4 2 2)"
refuses "OPTIMIZATION is -O0 to -O3, -Os, -Og, -Oz or project, not 'fast'" engine "$(has 4 2 2)" -DCRANKLOOP_SCENE_OPTIMIZATION=fast
refuses "does not run here (it does not exist); crankloop 0" engine "$(has 4 2 2)" -DCRANKLOOP_PROGRAM=/no/such/program
languages=C
refuses "project(asks LANGUAGES C CXX)" engine "$(has 4 2 2)"
languages=CXX
printf '#!/bin/sh\necho crankloop 9.9.9\n' >"$work/other"
chmod +x "$work/other"
refuses "is 'crankloop 9.9.9'; crankloop 0" engine "$(has 4 2 2)" "-DCRANKLOOP_PROGRAM=$work/other"
refuses "does not run here (1); crankloop 0" engine "$(has 4 2 2)" -DCRANKLOOP_PROGRAM=/bin/false
refuses "those of the engine file's [layout]" engine "$(has 3 2 2)"
refuses "valve trains, each a [cam NAME], a [rocker NAME] " engine "$(has 4 3 2)"
refuses "[trigger NAME] sections" engine "$(has 4 2 1)"

# with_scene SCENE FILE: the next project's.
with_scene() { scene=$1 engine_file=$2; }
with_scene Elastic "$engines/diesel_495.ini"
project engine "$(has 4 2 2)" || { cat "$work/said" && failures=1; }
sed 's/^spring_preload_N.*/&\
surge_modes = 1/' "$engines/diesel_495.ini" >"$work/surge.ini"
with_scene Elastic "$work/surge.ini"
refuses 'needs as many `spring_modes`' engine "$(has 4 2 2)"
with_scene Elastic "$engines/four_2000.ini"
refuses 'needs `valve_gas = true`' engine "$(has 4 2 2)"
with_scene Breathes "$engines/four_2000.ini"
project engine "$(has 4 2 2)" || { cat "$work/said" && failures=1; }
with_scene Breathes "$engines/diesel_495.ini"
refuses 'gas exchange `source = gas` in' engine "$(has 4 2 2)"
with_scene Forces "$engines/diesel_495.ini"
project engine "$(has 4 2 2)" || { cat "$work/said" && failures=1; }
sed 's/^rod_small_end_g.*/rod_g = 1887/; s/^rod_big_end_g.*/rod_com_to_crank_mm = 56.2\
rod_inertia_kg_mm2 = 15000/' "$engines/diesel_495.ini" >"$work/rod.ini"
with_scene Forces "$work/rod.ini"
refuses 'needs `rod_inertia = true`' engine "$(has 4 2 2)"
exit $((failures > 0))
