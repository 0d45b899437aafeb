#!/bin/sh
# left_out.sh FOLDER: what a scene leaves out is not in its library. In FOLDER are the libraries of scenes/; each must
# hold exactly the tables that its scene reads, and code of valves only where it has valves. An archive that asks
# nothing of others (archive_audit.sh) is all there is.
set -eu
folder=$1

bad=0
complain() { bad=$((bad + 1)) && echo "$*"; }

# holds SCENE TABLE...: these and no others.
holds() {
  scene=$1
  shift
  wanted=$(printf '%s\n' drive "$@" | sort)
  for real in float double; do
    found=$(nm --demangle --defined-only "$folder/lib${scene}_$real.a" | sed -n 's/^.* crankloop_tables:://p' | sort)
    [ "$found" = "$wanted" ] || complain "${scene}_$real holds the tables" "$found" "instead of" "$wanted"
  done
}

# has_code SCENE yes|no PATTERN: functions or data whose names match.
has_code() {
  for real in float double; do
    sizes=$(nm --demangle --defined-only --size-sort --print-size "$folder/lib${1}_$real.a" | grep -E "$3" || true)
    case $2:$sizes in
      yes:) complain "${1}_$real has nothing of $3" ;;
      no:?*) complain "${1}_$real has:" "$sizes" ;;
    esac
  done
}

gas_and_mass='torque_grid gas_torque_full gas_full inertia_torque'
# shellcheck disable=SC2086  # a list of words
{
  holds PistonMotion motion
  holds TorqueOnly $gas_and_mass
  holds ForcesAndTorque $gas_and_mass gas_grid body motion lean pressure_full
  holds ValveLift lift_curves lift_segments rocker_ratios
  holds ValveDynamics lift_curves lift_segments rocker_ratios valve_motions near_cams
  holds TriggerSignals triggers trigger_tracks trigger_edges
}
for scene in PistonMotion TorqueOnly ForcesAndTorque; do has_code $scene no '[Vv]alve|[Ll]ift|[Cc]am|[Rr]ocker|Contact'; done
has_code ValveLift no 'EventLocator|ValveMotion|valve_motion|Elastic|elastic|Contact|Record'
has_code ValveDynamics no 'pressure|gas_|ValveRecord|rod_|body'
has_code ValveLift yes 'lift'
has_code ValveDynamics yes 'EventLocator'
has_code WholeEngine yes 'ValveRecord'
for scene in PistonMotion TorqueOnly ForcesAndTorque ValveLift ValveDynamics WholeEngine; do has_code $scene no '[Tt]rigger|Sweep|Pace'; done
has_code TriggerSignals no '[Vv]alve|[Ll]ift|Bent|[Tt]orque'
has_code TriggerSignals yes 'TriggerTick'
[ "$bad" -eq 0 ]
