#!/bin/sh
# run.sh PROGRAM.exe ARGUMENT...: starts it by Wine, whose settings and fixtures stay in CRANKLOOP_WINE (default: a
# folder under /tmp). Tests that run at the same time share one Wine server.
set -eu
WINEPREFIX=${CRANKLOOP_WINE:-/tmp/crankloop-wine-$(id -u)}
WINEDEBUG=${WINEDEBUG:--all}
WINEDLLOVERRIDES='mscoree,mshtml='  # neither .NET nor a browser: it would offer to download them
export WINEPREFIX WINEDEBUG WINEDLLOVERRIDES
exec wine "$@"
