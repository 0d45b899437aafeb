#!/bin/sh
# performance_sees.sh CHECKOUT: tests/contract/figures/performance.sh finds a changed figure in each of its documents, and
# renews it.
set -eu
script=$1/tests/contract/figures/performance.sh
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir -p "$folder/docs" "$folder/tests/contract"
cp -R "$1/docs/performance.md" "$1/docs/measurements" "$folder/docs"
cp -R "$1/tests/contract/bench" "$folder/tests/contract"
cp "$1/README.md" "$folder"

bad=0
# changed FILE SED: the check fails; and where it is the page that was changed, renewing brings back what was.
changed() {
  cp "$folder/$1" "$folder/kept"
  sed "$2" "$folder/kept" >"$folder/$1"
  if cmp -s "$folder/$1" "$folder/kept"; then echo "$1: $2 changes nothing" && bad=1; fi
  if "$script" "$folder" check >/dev/null 2>&1; then echo "not seen in $1: $2" && bad=1; fi
  [ "$1" != docs/performance.md ] || "$script" "$folder" renew
  cmp -s "$folder/$1" "$folder/kept" || [ "$1" != docs/performance.md ] || { echo "not renewed: $2" && bad=1; }
  cp "$folder/kept" "$folder/$1"
}
"$script" "$folder" check
changed docs/performance.md '/^| motion, forces, torque [^\/]*$/s/ [0-9]/ 1&/'
changed docs/performance.md '/^| forces and torque .*\//s/ [0-9]/ 1&/'
changed docs/performance.md '/^| whole tick | library/s/1\.00/1.01/'
changed docs/performance.md '/^| located RK4 .* 100 us/s/| 2/| 3/'
changed docs/performance.md '/^| torque, 8 elastic valves/d'
changed docs/measurements/host.md '/^| motion, forces, torque/s/ [0-9]/ 1&/'
changed docs/measurements/cortex_m4f.md '/^| ElasticValves | 100/s/ [0-9]/ 1&/6'
changed docs/measurements/cortex_m4f.md '/^| ElasticValves | 20/s/ [0-9]/ 1&/6'
changed docs/measurements/benchmark.md '/^| library | float | 1 deg/d'
changed docs/measurements/benchmark.md '/^| located RK4 | double | 7000 rpm, 20 us/s/[0-9.]* um/9 um/'
changed docs/measurements/benchmark.md '/^| motion-float/s/4/5/'
changed tests/contract/bench/errors.csv '/^valve,cam-following,float,7000 rpm; 10 us,/s/,[0-9.]*,um/,1,um/'
changed tests/contract/bench/instructions.txt '/^torque-float/d'
changed README.md 's/torque from tables takes/& about/'
exit $bad
