#!/bin/sh
# shared_c.sh LIBRARY
# The shared C interface shows crankloop_* and nothing else, and needs no C++ library.
set -eu
library=$1
names=$(nm -D --defined-only "$library" | awk '{ print $3 }')
echo "$(echo "$names" | wc -l) names"
[ "$(echo "$names" | grep -c '^crankloop_[fd]_step$')" -eq 2 ] || { echo 'no crankloop_f_step, crankloop_d_step' && exit 1; }
others=$(echo "$names" | grep -v '^crankloop_' || true)
[ -z "$others" ] || { echo "also shown: $others" && exit 1; }
needed=$(nm -D --undefined-only "$library" | grep ' U ' | grep -vE ' mem(cpy|set|move)(@|$)' || true)
[ -z "$needed" ] || { echo "needs from outside: $needed" && exit 1; }
