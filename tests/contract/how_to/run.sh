#!/bin/sh
# run.sh CRANKLOOP FOLDER: runs the programs of docs/how_to.md, here, and `crankloop` on its engine files in FOLDER.
set -eu
crankloop=$1 folder=$2
fail() { echo "docs/how_to.md: $*" >&2 && exit 1; }

for program in tick_length crank edges vvt own_main many snapshot; do ./$program || fail "$program failed"; done
./faults >faults.txt || fail "faults failed"
printf 'not ready\nspeed, load ratio\n' | cmp - faults.txt || fail "faults does not say what its comments do"

# A warning would be on stderr. The trace is the 495's, whose net mean effective pressure is 809.7 kPa.
"$crankloop" run "$folder/measured.ini" --cycles 1 >measured.txt 2>warnings.txt
[ ! -s warnings.txt ] || fail "measured.ini: $(cat warnings.txt)"
awk '$1 == "net_mep_exact" { found += $3 > 809.5 && $3 < 810.5 } $1 == "net_mep_per_degree" { found += $3 > 58.5 && $3 < 59.5 }
  END { exit found != 2 }' measured.txt || fail "$(cat measured.txt)"
"$crankloop" balance "$folder/balanced.ini" --mount-width-mm 250 --mount-length-mm 300 >balance.csv
awk -F, '$1 == "bare_force_first_N" { bare = $2 } $1 == "residual_force_first_N" { left = $2 } /^mount_/ { ++mounts }
  END { exit !(bare > 13450 && bare < 13550 && left < 1e-6 && mounts == 16) }' balance.csv || fail "balanced.ini: $(cat balance.csv)"

"$crankloop" lift "$folder/own_cam.ini" --csv lift.csv >lift.txt
awk '$1 == "max_theoretical_lift" { found = $3 > 10.45 && $3 < 10.55 } END { exit !found }' lift.txt || fail "$(cat lift.txt)"
