#!/bin/sh
# c_headers_agree.sh INCLUDE_DIR [--renew]
# crankloop_double.h says of double what crankloop_float.h says of float, word by word; --renew writes it anew.
set -eu
float=$1/crankloop/crankloop_float.h double=$1/crankloop/crankloop_double.h

as_double() {
  sed -e 's/crankloop_double\.h is this file.*/crankloop_float.h is this file with double, _d_ and _D_ replaced (tests\/contract\/c_headers_agree.sh): edit that one./' \
    -e 's/crankloop_f_/crankloop_d_/g' -e 's/CRANKLOOP_F_/CRANKLOOP_D_/g' -e 's/CRANKLOOP_FLOAT/CRANKLOOP_DOUBLE/' \
    -e '/_float\.h/!s/\([^_]\)float/\1double/g' "$float"
}
if [ "${2:-}" = --renew ]; then
  as_double >"$double"
else
  as_double | diff -u "$double" - || { echo "renew it: $0 $1 --renew" && exit 1; }
fi
