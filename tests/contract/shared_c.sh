#!/bin/sh
# shared_c.sh LIBRARY PYTHON_PROGRAM
# The shared C interface shows crankloop_* and nothing else, needs no C++ library, and Python's ctypes can drive it (where there is Python).
set -eu
library=$1 program=$2
names=$(nm -D --defined-only "$library" | awk '{ print $3 }')
echo "$(echo "$names" | wc -l) names"
[ "$(echo "$names" | grep -c '^crankloop_[fd]_step$')" -eq 2 ] || { echo 'no crankloop_f_step, crankloop_d_step' && exit 1; }
others=$(echo "$names" | grep -v '^crankloop_' || true)
[ -z "$others" ] || { echo "also shown: $others" && exit 1; }
needed=$(nm -D --undefined-only "$library" | grep ' U ' | grep -vE ' mem(cpy|set|move)(@|$)' || true)
[ -z "$needed" ] || { echo "needs from outside: $needed" && exit 1; }
if command -v python3 >/dev/null; then
  said=$(python3 "$program" "$library")
  echo "$said"
  case $said in *' Nm after a cycle, faults 0') ;; *) exit 1 ;; esac
else
  echo 'no python3: not driven by it'
fi
