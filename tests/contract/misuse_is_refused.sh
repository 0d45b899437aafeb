#!/bin/sh
# misuse_is_refused.sh COMPILER INCLUDE_DIR
# Mistakes that a user could make do not compile, and the compiler says why. Each is tried beside its correct form,
# which must compile: so that a slip in the case itself cannot pass for a refusal.
set -eu
compiler=$1 include_dir=$2

cases=0 bad=0
flags='-std=c++17 -Wall -Wextra -Wconversion -Werror'

# g++ reads the library once for all cases; clang++ takes no such file for an #include, and reads the library each time.
precompiled=$(mktemp -d)
trap 'rm -rf "$precompiled"' EXIT
mkdir "$precompiled/crankloop"
# shellcheck disable=SC2086  # a list of words
"$compiler" -w $flags -I "$include_dir" -x c++-header "$include_dir/crankloop/crankloop.hpp" -o "$precompiled/crankloop/crankloop.hpp.gch"

# accepts CODE: prints what the compiler says; answers whether it accepts.
# shellcheck disable=SC2086  # a list of words
accepts() {
  printf '#include <crankloop/crankloop.hpp>\nusing namespace crankloop;\n%s\n' "$1" |
    "$compiler" -fsyntax-only -I "$precompiled" $flags -I "$include_dir" -x c++ - 2>&1
}

# refuses MESSAGE CODE RIGHT WRONG: CODE with its @ replaced by RIGHT compiles; by WRONG it does not, and the compiler
# says MESSAGE.
refuses() {
  cases=$((cases + 1))
  if ! said=$(accepts "${2%%@*}$3${2#*@}"); then
    bad=$((bad + 1)) && printf 'the right form does not compile: %s\n%s\n' "$3" "$said"
  fi
  if said=$(accepts "${2%%@*}$4${2#*@}"); then
    bad=$((bad + 1)) && printf 'compiles, but must not: %s\n' "$4"
  elif ! printf '%s' "$said" | grep -Eq -e "$1"; then
    bad=$((bad + 1)) && printf 'refused, but without saying "%s": %s\n%s\n' "$1" "$4" "$said"
  fi
}

# ---- scenes that make no sense ---------------------------------------------------------------------------------------

# A scene of these answers, and its engine.
engine_of='struct S : Scene {
  static constexpr Count cylinders = exactly<4>;
  @
};
Engine<float, S> engine;'
any_cylinders='struct S : Scene {
  static constexpr Count cylinders = @;
};
Engine<float, S> engine;'

refuses 'a scene has at least one cylinder' "$any_cylinders" 'exactly<1>' 'exactly<0>'
refuses 'a scene has at least one cylinder' "$any_cylinders" 'up_to<1>' 'up_to<0>'
refuses 'a scene has at most 16 cylinders' "$any_cylinders" 'exactly<16>' 'exactly<17>'
refuses 'a scene has at most 16 cylinders' "$any_cylinders" 'up_to<16>' 'up_to<17>'
yes='= true;'
forces='static constexpr bool forces = true;'
by_table='static constexpr auto pressure = PressureGiven::by_table;'
by_input='static constexpr auto pressure = PressureGiven::by_input;'
elastic='static constexpr auto valves = ValveModel::elastic;'
following='static constexpr auto valves = ValveModel::following;'
refuses 'bearing_loads are made from forces' "$engine_of" "static constexpr bool bearing_loads $yes $forces" \
  "static constexpr bool bearing_loads $yes"
refuses 'load_ratio scales a pressure table' "$engine_of" "static constexpr bool load_ratio $yes $by_table" \
  "static constexpr bool load_ratio $yes $by_input"
refuses 'a cylinder has 1 to 4 valve trains' "$engine_of" "$following static constexpr Count trains = exactly<4>;" \
  "$following static constexpr Count trains = exactly<5>;"
refuses 'valve forces, results and gas force need elastic valves' "$engine_of" "$elastic static constexpr bool valve_forces $yes" \
  "$following static constexpr bool valve_forces $yes"
refuses 'valve forces, results and gas force need elastic valves' "$engine_of" "$elastic static constexpr bool valve_results $yes" \
  "static constexpr bool valve_results $yes"
for answer in cam_contact cam_torque; do
  refuses 'cam_contact and cam_torque need elastic valves' "$engine_of" "$elastic static constexpr bool $answer $yes" \
    "$following static constexpr bool $answer $yes"
done
turned='static constexpr auto crank = CrankGiven::torque;'
refuses 'cam_drag needs cam_torque' "$engine_of" \
  "$elastic $turned static constexpr bool cam_torque $yes static constexpr bool cam_drag $yes" \
  "$elastic static constexpr bool cam_torque $yes static constexpr bool cam_drag $yes"
refuses 'cam_phasing needs valves' "$engine_of" "$following static constexpr bool cam_phasing $yes" "static constexpr bool cam_phasing $yes"
for answer in theoretical_lift valve_acceleration; do
  refuses 'theoretical_lift and valve_acceleration need valves' "$engine_of" "$following static constexpr bool $answer $yes" \
    "static constexpr bool $answer $yes"
done
refuses 'valve_gas needs a pressure' "$engine_of" "$elastic $by_input static constexpr bool valve_gas $yes" \
  "$elastic static constexpr bool valve_gas $yes"

refuses 'at most 8 trigger wheels' "$engine_of" 'static constexpr Count triggers = up_to<8>;' 'static constexpr Count triggers = up_to<9>;'
refuses 'trigger_edges is 1 to 1440' "$engine_of" 'static constexpr std::uint32_t trigger_edges = 1;' 'static constexpr std::uint32_t trigger_edges = 0;'

# ---- what the scene left out -----------------------------------------------------------------------------------------

motion='struct S : Scene { static constexpr bool kinematics = true; };
float f(Engine<float, S>& engine, Engine<float, S>::Input& in) { @ }'
refuses "no member named .torque_Nm" "$motion" 'return engine.step(in).velocity_m_s[0];' 'return engine.step(in).torque_Nm;'
refuses "no member named .cylinder" "$motion" 'return engine.step(in).displacement_m[0];' 'return engine.step(in).cylinder[0].gas_force_N;'
refuses "no member named .valve" "$motion" 'return engine.step(in).acceleration_m_s2[0];' 'return engine.step(in).valve[0][0].lift_m;'
moves='struct S : Scene { static constexpr auto valves = ValveModel::elastic; };
float f(Engine<float, S>& engine, Engine<float, S>::Input& in) { return engine.step(in).valve[0][0].@; }'
refuses "no member named .theoretical_lift_m" "$moves" 'lift_m' 'theoretical_lift_m'
refuses "no member named .acceleration_m_s2" "$moves" 'velocity_m_s' 'acceleration_m_s2'
refuses "no member named .trigger" "$motion" 'return engine.step(in).acceleration_m_s2[0];' 'return engine.step(in).trigger[0].edge[0].time_s;'
refuses "no member named .load_ratio" "$motion" 'in.speed_rad_s = 1; return engine.step(in).velocity_m_s[0];' \
  'in.load_ratio = 1; return engine.step(in).velocity_m_s[0];'
refuses "no member named .crank" "$motion" 'in.speed_rad_s = 1; return engine.step(in).velocity_m_s[0];' \
  'in.crank = Phase{1}; return engine.step(in).velocity_m_s[0];'
refuses "no member named .motion" \
  'struct S : Scene { static constexpr bool @ = true; }; const void* f(const Tables<float, S>& tables) { return tables.motion; }' \
  'kinematics' 'rod_motion'

# ---- slips of the hand -----------------------------------------------------------------------------------------------

refuses 'narrow' 'group::SpeedInput<float> f(double speed_rad_s) { return {@}; }' 'static_cast<float>(speed_rad_s)' 'speed_rad_s'
refuses 'conversion' 'void f(group::SpeedInput<float>& in, double speed_rad_s) { in.speed_rad_s = @; }' 'static_cast<float>(speed_rad_s)' 'speed_rad_s'
refuses 'conver' 'Phase f() { return @; }' 'Phase{1}' '1'
refuses 'nodiscard' 'struct S : Scene {}; void f(Engine<float, S>& engine, const Tables<float, S>& tables) { @engine.init(tables); }' \
  'if (!engine.init(tables).ok()) return; (void)' ''
refuses 'delete' 'struct S : Scene {}; bool f(Engine<float, S>& engine, const Tables<float, S>& tables) { return engine.init(@).ok(); }' \
  'tables' 'Tables<float, S>{tables}'
refuses 'delete' 'struct S : Scene {}; using Storage = TableStorage<float, S>; Storage one; Storage @;' 'other' 'other{one}'
refuses 'delete' 'struct S : Scene {}; TableStorage<float, S> one, other; void f() { @; }' '(void)other.tables()' 'other = one'
refuses '720 to 14400 gas segments' 'struct S : Scene {}; TableStorage<float, S, @> storage;' '720' '719'
refuses 'enum|conver|assign|initializ' 'struct S : Scene {
  static constexpr PressureGiven pressure = @;
};' 'PressureGiven::by_input' 'CrankGiven::phase'

echo "$cases cases, $bad bad"
[ "$bad" -eq 0 ]
