#!/bin/sh
# step_cost.sh FMU_COST MOST: what doStep of one tick, without get and set, costs above the tick itself: instructions, the
# difference of two runs' lengths, FMU against the scene driven directly. Fails above MOST.
set -eu
# shellcheck source=../contract/instructions.sh
. "$(dirname -- "$0")/../contract/instructions.sh"
program=$1 most=$2
ticks=4000
per_tick() {  # SCENE VERSION: in hundredths
  few=$(instructions "$program" "$1" "$2" 1000)
  many=$(instructions "$program" "$1" "$2" $((1000 + ticks)))
  echo $(((many - few) * 100 / ticks))
}
bad=0
for scene in four_pistons measured_motion torque_by_table torque_by_pressure trigger_wheels bouncing_valve whole \
  free_running breathing_free; do
  direct=$(per_tick "$scene" 0)
  for version in 2 3; do
    whole=$(per_tick "$scene" "$version")
    more=$(((whole - direct + 50) / 100))
    echo "$scene, FMI $version: a tick of $((direct / 100)) instructions, doStep $more more"
    [ "$more" -le "$most" ] || bad=1
  done
done
[ "$bad" -eq 0 ] || echo "more than $most"
[ "$bad" -eq 0 ]
