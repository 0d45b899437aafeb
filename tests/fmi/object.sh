#!/bin/sh
# object.sh SHARED_OBJECT SCENE|FILE: what an importer's loader sees of an FMU's shared object.
#
# Nothing but fmi2* and fmi3* is seen from outside; nothing is needed but the C library and what comes with it; no path
# is searched. Nothing is needed that is newer than glibc 2.17 of 2012, the oldest for aarch64, be the machine that builds
# as new as it likes: an FMU is loaded by a simulator on an older one.
set -eu
object=$1
bad=0
complain() {
  echo "$object: $*"
  bad=1
}
exported=$(nm -D --defined-only "$object" | sed 's/.* //')
[ "$(echo "$exported" | wc -l)" -eq 119 ] || complain "$(echo "$exported" | wc -l) functions: 44 of FMI 2, 75 of FMI 3 are"
if echo "$exported" | grep -vE '^fmi[23][A-Z]'; then complain 'exports these too'; fi
allowed='libc\.so\.6|libm\.so\.6|ld-linux-[a-z0-9-]+\.so\.[0-9]+'
if readelf -d "$object" | grep NEEDED | grep -vE "\[($allowed)\]"; then complain 'needs these'; fi
if readelf -d "$object" | grep -E 'RPATH|RUNPATH'; then complain 'has a search path'; fi
readelf -d "$object" | grep -q SYMBOLIC || complain 'is not bound to its own symbols'
newest=$(readelf -V "$object" | grep -oE 'GLIBC_2\.[0-9]+' | sort -t. -k2n | tail -n 1)
echo "$object: needs glibc ${newest#GLIBC_}"
[ "${newest#GLIBC_2.}" -le 17 ] || complain "needs $newest"
if [ "$2" = SCENE ]; then
  # the one constructor is the C compiler's own, which does nothing here
  size=$(readelf -d "$object" | awk '/INIT_ARRAYSZ/ { print $3 }')
  [ "${size:-0}" -le 8 ] || complain "has constructors: $size bytes of them"
fi
[ "$bad" -eq 0 ]
