#!/bin/sh
# run.sh ENGINE_FILE: what the programs of docs/c_interface.md print, in the folder where they were built.
set -eu

# A 60-2 wheel: 58 teeth rise in a turn, evenly but for the gap, which is three times as wide; each falls again.
./edges >edges.txt
awk '
  $3 == "rises" {
    apart = $1 - last
    if (rises > 1 && apart > 2 * before) {
      gaps += 1
      if (gaps > 1 && teeth != 58) bad = "teeth in a turn: " teeth
      if (apart < 2.8 * before || apart > 3.2 * before) bad = "gap: " apart / before
      teeth = 0
    }
    before = apart; last = $1; ++rises; ++teeth
  }
  $3 == "falls" { ++falls }
  END {
    if (gaps < 2) bad = "gaps: " gaps
    if (rises - falls > 1 || falls - rises > 1) bad = "falls: " falls
    print rises, "teeth,", gaps, "gaps"
    if (bad) { print "not so:", bad; exit 1 }
  }' edges.txt

./file "$1" >file.txt
grep -E '^-?[0-9]+[.][0-9]+ Nm after 100000 ticks, faults 0$' file.txt
if ./file /nowhere.ini >refused.txt; then echo 'an engine file that is not there was read' && exit 1; fi
grep -q '^/nowhere.ini' refused.txt
