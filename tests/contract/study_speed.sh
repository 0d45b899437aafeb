#!/bin/sh
# study_speed.sh CRANKLOOP ENGINE_FILE
# A study of 1000 points takes two threads at most 1 / 1.8 of the time that it takes one, with the same bytes. Best of five;
# skipped (77) where there are not two processors, or others used them before or after any that took longer.
set -eu
crankloop=$1 engine=$2
[ "$(nproc)" -ge 2 ] || exit 77

# busy: others take more than 5 % of the processors over a second.
busy() {
  awk '/^cpu /{ print $5, $2 + $3 + $4 + $5 + $6 + $7 + $8 }' /proc/stat >before
  sleep 1
  awk '/^cpu /{ print $5, $2 + $3 + $4 + $5 + $6 + $7 + $8 }' /proc/stat | paste before - |
    awk '{ exit !($3 - $1 < 0.95 * ($4 - $2)) }'
}
# study THREADS: the nanoseconds it takes.
study() {
  start=$(date +%s%N)
  "$crankloop" study "$engine" --vary crank.rod_length_mm=90:120:40 rpm=5000:9000:25 --of kinematics.max_acceleration \
    --threads "$1" --csv "$1.csv" >/dev/null 2>"$1.err"
  echo $(($(date +%s%N) - start))
}

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
disturbed=
for attempt in 1 2 3 4 5; do
  if [ -z "${CRANKLOOP_BUSY_TOO:-}" ] && busy; then disturbed=yes && continue; fi
  one=$(study 1) two=$(study 2)
  cmp 1.csv 2.csv
  [ "$(wc -l <1.csv)" = 1001 ]
  echo "attempt $attempt: $((one / 1000000)) ms by one thread, $((two / 1000000)) ms by two: $((one * 100 / two)) %"
  [ $((one * 10)) -lt $((two * 18)) ] || exit 0
  if busy; then disturbed=yes; fi
done
[ -z "$disturbed" ] || { echo 'the machine is busy' && exit 77; }
exit 1
