#!/bin/sh
# unit_suffixes.sh INCLUDE_DIR
# Every floating-point member, parameter and function of the interface ends in its unit, or stands below with the reason
# why it has none.
#
# The interface is what a user reads and fills in: definitions, what tabulate answers, input, output and state of a
# step. Not looked at: private members, the bodies of functions (lines indented deeper than a member), and
# elementary.hpp, whose arguments are pure numbers.
set -eu
cd "$1/crankloop"
interface=$(find define tabulate engine.hpp input.hpp output.hpp state.hpp tables/records.hpp tables/tables.hpp tick/trigger/trigger_output.hpp tick/valve/valve_results.hpp tick/gas/gas_results.hpp tick/gas/gas_state.hpp -name "*.hpp" ! -name elementary.hpp | sort)

units='m|m2|m3|m_s|m_s2|rad|rad_s|rad_s2|deg|deg_s|deg_per_s|rpm|s|kg|kg_m|kg_m2|N|Nm|N_m|Ns_m|Nm_s|Nm_s2|Pa_s|Pa_s2|J|W|K|Pa|Hz|V|V_s|ratio'

allowed='
compression_exponent expansion_exponent motored_expansion_exponent motored_exponent kMotoredLoss exponents  # of power laws
coefficients a0 a1 a2 a4 a6 order                  # of polynomials and Fourier series; coefficients of what they multiply
at value least most limit                          # degree or m^3, Pa or m: as the row, the quantity or the range says
ratio octane_number knock_integral volumetric_efficiency combustion_efficiency margin spring_margin surge_growth kMostSurgeGrowth   # its own unit
per_crank_radius per_rod_length                    # 1/m
rad_s_per_cycle_per_tick                           # named by its unit
up_cos up_sin lateral_cos lateral_sin pitch_cos pitch_sin yaw_cos yaw_sin  # amplitudes per w^2: kg m and kg m^2
trigger faulty_trigger comparator valve                       # signals and motions, whose members have their unit
throw_cos throw_sin quantum # numbers
reduced_speed reduced_rest per_root_inertia  # sqrt(J) and 1/sqrt(kg m2)
amplitude cosine sine wave_of                      # of a wave of any unit
regime segment                                     # numbers of several units, lane by lane
from to largest x slope_from slope_to spare        # parameters of numbers, in helpers that serve any unit; filling
spare_of_manifolds spare_of_sensor spare_number                    # filling
offset noise step held late lagged lagged_rest sample sensor faulty_sensor # of sensors: Pa, K or 1
peak magnitude Pose PoseMember PoseFunction tables state turning_at # functions and types that serve any unit
'

# What a floating-point name looks like: after its type, by itself, in a list (Real a, b;) or as a parameter.
names=$(for header in $interface; do
  sed -e 's,//.*,,' "$header" | awk -v header="$header" '
    /^ private:/ { hidden = 1 }
    /^};/ { hidden = 0 }
    hidden || !/^(  )?[^ ]/ { next }
    {
      line = $0
      while (match(line, /(^|[^A-Za-z0-9_])(std::array<)?(float|double|Real)(, *[A-Za-z0-9_:]+>)?( const)?[ &*]+[A-Za-z_][A-Za-z0-9_]*/)) {
        name = substr(line, RSTART, RLENGTH)
        sub(/.*[ &*]/, "", name)
        print header, name
        line = substr(line, RSTART + RLENGTH)
        # the rest of a list of members
        while (line !~ /\(/ && $0 !~ /\(/ && match(line, /^(\[[^]]*\])*( *= *[^,;]*|\{[^}]*\})?, *[a-z_][A-Za-z0-9_]*/)) {
          name = substr(line, RSTART, RLENGTH)
          sub(/.*[ ,]/, "", name)
          print header, name
          line = substr(line, RSTART + RLENGTH)
        }
      }
    }'
done)
[ "$(echo "$names" | wc -l)" -gt 100 ] || { echo "found only: $names" && exit 1; }

found=$(echo "$names" | grep -vE "_($units)_?\$" | sort -u | while read -r header name; do
  echo "$allowed" | sed 's/#.*//' | tr ' ' '\n' | grep -qx "$name" || echo "$header: $name has no unit"
done)
echo "$(echo "$names" | wc -l) names"
[ -z "$found" ] || { echo "$found" && exit 1; }
