#!/bin/sh
# docs/performance.md is made of docs/measurements, and the errors and instructions of the benchmark's page there are those
# that tests/contract/bench holds.
#
#   performance.sh CHECKOUT check   fails when a figure differs; also when the README tells other costs of a Cortex-M4F
#   performance.sh CHECKOUT renew   writes the figures anew; times stay
set -eu
what=${2:-}
case $what in check | renew) ;; *) sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$0" >&2 && exit 2 ;; esac
cd "$1"
bench=tests/contract/bench
measurements=docs/measurements
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Errors and instructions of the committed lists, in the rows of the benchmark's page.
awk -v errors=$bench/errors.csv -v instructions=$bench/instructions.txt '
  BEGIN {
    while ((getline line <errors) > 0) {
      split(line, cell, ",")
      for (i in cell) gsub(/;/, ",", cell[i])
      if (cell[5] != "") error[cell[2] "|" cell[3] "|" cell[4]] = sprintf("%.2g %s", cell[5], cell[6])
    }
    while ((getline line <instructions) > 0) {
      if (line ~ /^#/) compiler = substr(line, 3)
      else if (split(line, cell, " ") == 2) { count[cell[1]] = cell[2]; names[++kernels] = cell[1] }
    }
  }
  /^Instructions, counted by valgrind; / { print "Instructions, counted by valgrind; " compiler ":"; next }
  /^\| kernel / { table = 1; print; next }
  table && /^\| ---/ { print; for (i = 1; i <= kernels; ++i) print "| " names[i] " | " count[names[i]] " |"; next }
  table && /^\|/ { next }
  {
    table = 0
    n = split($0, cell, / \| /)
    name = substr(cell[1], 3)
    if (n >= 5 && (name "|" cell[2] "|" cell[3]) in error) {
      sub(/ \| [^|]* \|$/, "")
      $0 = $0 " | " error[name "|" cell[2] "|" cell[3]] " |"
    }
    print
  }' $measurements/benchmark.md >"$work/benchmark.md"

# row CONTESTANT REAL SETTING: of the benchmark, "time|error", and "|worst" where there is one.
row() {
  awk -v contestant="$1" -v real="$2" -v setting="$3" '
    { n = split($0, cell, / \| /) }
    substr(cell[1], 3) == contestant && cell[2] == real && cell[3] == setting {
      sub(/ \|$/, "", cell[n])
      print cell[4] "|" cell[n] (n > 5 ? "|" cell[7] : "")
      found = 1
      exit
    }
    END { if (!found) { print "no row: " contestant ", " real ", " setting >"/dev/stderr"; exit 1 } }' "$work/benchmark.md"
}

# ---- the tables ------------------------------------------------------------------------------------------------------

scenes() {
  echo "| x86-64, float | code, bytes | tables, bytes | RAM, bytes | stack, bytes | instructions | ns |"
  echo "| --- | --- | --- | --- | --- | --- | --- |"
  awk -F ' *[|] *' '
    /^(Float|Double):$/ { real = $0 }
    real == "Float:" && NF == 9 && $3 ~ /^[0-9]/ { print "| " $2 " | " $3 " | " $4 " | " $5 " | " $6 " | " $7 " | " $8 " |" }
  ' $measurements/host.md
  echo
  echo "| Cortex-M4F, float | code, bytes | tables, bytes | RAM, bytes | stack, bytes | instructions, mean / worst | bound, any input | cycles, mean / worst | bound, any input | % of the tick at 180 MHz, mean / worst / bound |"
  echo "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"
  awk -F ' *[|] *' '
    BEGIN {
      name["TorqueOfPressures"] = "torque of given pressures"
      name["TorqueOfTables"] = "torque of tabled pressures"
      name["MeanTorque"] = "torque averaged over the tick"
      name["Forces"] = "forces and torque"
      name["FollowingValves"] = "torque, 8 cam-following valves"
      name["ElasticValves"] = "torque, 8 elastic valves"
      name["Everything"] = "everything"
      name["ClosedLoop"] = "closed loop: crank speed, starter, wheels"
      name["Fired"] = "gas exchange, fired, throttle"
    }
    /^Cycles, / { cycles = 1; zero = /^Cycles, 0 / }
    $3 != 100 || !($2 in name) { next }
    !cycles { rows[++count] = $2; row[$2] = "| " name[$2] " | " $9 " | " $10 " | " $11 " | " $12 " | " $6 " | " $8 " |" }
    zero { row[$2] = row[$2] " " $4 " | " $6 " | " $7 " |" }
    END { for (i = 1; i <= count; ++i) print row[rows[i]] }
  ' $measurements/cortex_m4f.md
}

# What a group of results or a part of the gas takes more than the scene without it: per tick of four cylinders with eight valves.
groups() {
  echo "| four cylinders, float, 20 us | x86-64: instructions | code | tables | RAM | Cortex-M4F: instructions, mean / worst | bound, any input | cycles, mean / worst | bound, any input | code | tables | RAM |"
  echo "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"
  awk -F ' *[|] *' '
    function more(a, b) { return sprintf("%+d", a - b) }
    function two(a, b,    x, y) { split(a, x, " / "); split(b, y, " / "); return more(x[1], y[1]) " / " more(x[2], y[2]) }
    BEGIN {
      split("SurgingValves CamContactValves CamTorqueValves FiredCrevice FiredBlowBy FiredRunners FiredWalls FiredKnock FiredChargeBurn FiredLambda FiredSensors", order, " ")
      split("spring surge, two modes|contact of the cams|torque of the cams, friction|crevices|crevices, blow-by|runners, intake and exhaust|warm walls|knock|burn by charge|lambda behind a pipe|names and a faulty sensor of a controller", name, "|")
    }
    FNR == 1 { ++page; cycles = 0 }
    page == 1 && /^\| scene, one group each/ { groups = 1 }
    page == 1 && groups { for (i = 3; i <= 6; ++i) host[$2, i] = $i }
    /^Cycles, / { cycles = 1; zero = /^Cycles, 0 / }
    page == 2 && $3 == 20 && !cycles { for (i = 6; i <= 11; ++i) arm[$2, i] = $i }
    page == 2 && $3 == 20 && zero { arm[$2, "cycles"] = $4; arm[$2, "bound"] = $6 }
    END {
      for (i = 1; i in order; ++i) {
        n = order[i]
        b = n ~ /^Fired/ ? "Fired" : "ElasticValves"
        print "| " name[i] " | " more(host[n, 6], host[b, 6]) " of " host[b, 6] " | " more(host[n, 3], host[b, 3]) " | " more(host[n, 4], host[b, 4]) " | " \
          more(host[n, 5], host[b, 5]) " | " two(arm[n, 6], arm[b, 6]) " of " arm[b, 6] " | " more(arm[n, 8], arm[b, 8]) " | " two(arm[n, "cycles"], arm[b, "cycles"]) " | " \
          more(arm[n, "bound"], arm[b, "bound"]) " | " more(arm[n, 9], arm[b, 9]) " | " more(arm[n, 10], arm[b, 10]) " | " more(arm[n, 11], arm[b, 11]) " |"
      }
    }
  ' $measurements/host.md $measurements/cortex_m4f.md
}

# against TASK LIBRARY_ROW OTHER_ROW...: each row is CONTESTANT|REAL|SETTING; times over that of the first.
against() {
  task=$1
  shift
  first=
  for one in "$@"; do
    contestant=${one%%|*} rest=${one#*|}
    found=$(row "$contestant" "${rest%%|*}" "${rest#*|}")
    ns=${found%%|*} rest_of=${found#*|}
    first=${first:-$ns}
    echo "| $task | $contestant | ${rest%%|*} | ${rest#*|} | $ns | $(awk -v a="$ns" -v b="$first" 'BEGIN { printf "%.2f", a / b }') | ${rest_of%%|*} |"
  done
}

beside_plain_code() {
  echo "| task | by | real | setting | ns | time over first row's | largest error |"
  echo "| --- | --- | --- | --- | --- | --- | --- |"
  against "x, v, a of a piston" 'library|float|1 deg' 'linear|float|1 deg' 'quadratic|float|1 deg' 'libm sin/cos/sqrt|float|exact'
  against "x, v, a of a piston" 'library|double|1 deg' 'linear|double|1 deg' 'libm sin/cos/sqrt|double|exact'
  for speed in 7000 12000; do
    against "elastic valve, a cam cycle" "located RK4|float|$speed rpm, 10 us" "textbook RK4|float|$speed rpm, 10 us" "textbook RK4|float|$speed rpm, 1 us"
  done
  for engine in 'float|4 cylinders, 8 valves' 'float|4 cylinders, 16 valves' 'double|4 cylinders, 8 valves'; do
    setting="$engine, 6000 rpm, 20 us"
    against "whole tick" "library|$setting" "linear tables + textbook RK4|$setting" "libm + textbook RK4|$setting"
  done
}

# growing CONTESTANT FIRST_SETTING SETTING...
growing() {
  contestant=$1
  first=$(row "$contestant" float "$2")
  first=${first%%|*}
  shift 2
  for setting in "$@"; do
    found=$(row "$contestant" float "$setting")
    ns=${found%%|*}
    case $found in *'|'*'|'*) worst=${found##*|} ;; *) worst=- ;; esac
    echo "| $contestant | $setting | $ns | $(awk -v a="$ns" -v b="$first" 'BEGIN { printf "%.2f", a / b }') | $worst |"
  done
}

growth() {
  echo "| scene, float | grows | mean, ns | over 4 cylinders, 8 valves, 20 us | worst tick, ns |"
  echo "| --- | --- | --- | --- | --- |"
  at='6000 rpm, 20 us'
  growing 'library, any engine' "4 cylinders, 8 valves, $at" "1 cylinder, 2 valves, $at" "4 cylinders, 0 valves, $at" "4 cylinders, 4 valves, $at" \
    "4 cylinders, 8 valves, $at" "4 cylinders, 16 valves, $at" "8 cylinders, 16 valves, $at" "12 cylinders, 24 valves, $at" \
    "12 cylinders, 48 valves, $at"
  at='4 cylinders, 8 valves, 6000 rpm'
  growing 'located RK4' "$at, 20 us" "$at, 5 us" "$at, 20 us" "$at, 50 us" "$at, 100 us" "$at, 200 us"
}

# In docs/performance.md, what stands between "<!-- NAME begin" and "<!-- NAME end".
scenes >"$work/scenes"
groups >"$work/groups"
beside_plain_code >"$work/beside_plain_code"
growth >"$work/growth"
awk -v work="$work" '
  inside && /^<!-- [a-z_]* end -->/ { print ""; inside = 0; ++parts }
  !inside { print }
  /^<!-- [a-z_]* begin/ { inside = 1; print ""; part = work "/" $2; while ((getline line <part) > 0) print line }
  END { exit parts != 4 }' docs/performance.md >"$work/performance.md"

# The README tells the costs of two scenes on a Cortex-M4F.
told=$(awk -F ' *[|] *' '
  /^Cycles, / { cycles = 1; zero = /^Cycles, 0 / }
  $3 != 20 { next }
  !cycles && $2 == "TorqueOfTables" { torque = $6; sub(/ .*/, "", torque) }
  !cycles && $2 == "ElasticValves" { split($6, valves, " / ") }
  zero && $2 == "ElasticValves" { split($4, cycle, " / "); split($7, share, " / ") }
  END { print "On a Cortex-M4F, torque from tables takes " torque " instructions. Eight elastic valves at 6000 rpm and 20 us take " \
    valves[1] " on average and " valves[2] " in the worst tick; in cycles without wait states " cycle[1] " and " cycle[2] ", " \
    share[1] " and " share[2] " % of the tick at 180 MHz." }' $measurements/cortex_m4f.md)

bad=0
for page in docs/performance.md $measurements/benchmark.md; do
  cmp -s "$work/${page##*/}" "$page" && continue
  if [ "$what" = renew ]; then
    cp "$work/${page##*/}" "$page"
  else
    diff "$page" "$work/${page##*/}" || echo "$page: the lines with < are not what was measured; tests/contract/figures/performance.sh . renew"
    bad=1
  fi
done
tr -s ' \n' ' ' <README.md | grep -qF "$told" || { echo "README.md does not say: $told" && bad=1; }
exit $bad
