#!/bin/sh
# shared_c.sh LIBRARY_FOLDER
# The shared C interface shows crankloop_* and nothing else; the engines need nothing from outside, the reader of engine
# files nothing but the C library.
set -eu
only() { # only LIBRARY PREFIX COUNT FUNCTION
  names=$(nm -D --defined-only "$1" | awk '{ print $3 }')
  echo "$1: $(echo "$names" | wc -l) names"
  [ "$(echo "$names" | grep -cE "^$4\$")" -eq "$3" ] || { echo "not $3 of $4" && exit 1; }
  others=$(echo "$names" | grep -v "^$2" || true)
  [ -z "$others" ] || { echo "also shown: $others" && exit 1; }
}
engines=$1/libcrankloop_c.so files=$1/libcrankloop_engine_file.so
only "$engines" crankloop_ 4 'crankloop_(whole|free)_[fd]_step'
needed=$(nm -D --undefined-only "$engines" | grep ' U ' | grep -vE ' mem(cpy|set|move)(@|$)' || true)
[ -z "$needed" ] || { echo "needs from outside: $needed" && exit 1; }
only "$files" crankloop_engine_file_ 1 crankloop_engine_file_read
needed=$(objdump -p "$files" | awk '$1 == "NEEDED" && $2 !~ /^(libc|libm|ld-linux.*)[.]so/ { print $2 }')
[ -z "$needed" ] || { echo "needs $needed" && exit 1; }
