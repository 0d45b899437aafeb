#!/bin/sh
# run.sh PROGRAM.exe ARGUMENT...: starts it by Wine, whose settings and fixtures stay in CRANKLOOP_WINE (default: a
# folder under /tmp). Tests that run at the same time share one Wine server. It stays for 20 s, as a program that
# starts while a server ends finds neither that one nor a new one; and what it starts beside the program would keep a
# pipe open as long, so the program writes to a file.
set -eu
WINEPREFIX=${CRANKLOOP_WINE:-/tmp/crankloop-wine-$(id -u)}
WINEDEBUG=${WINEDEBUG:--all}
WINEDLLOVERRIDES='mscoree,mshtml='  # neither .NET nor a browser: it would offer to download them
export WINEPREFIX WINEDEBUG WINEDLLOVERRIDES
mkdir -p "$WINEPREFIX"
wineserver --persistent=20 </dev/null >/dev/null 2>&1 || true  # fails where there is one already, which is as well
printed=$(mktemp)
trap 'rm -f "$printed"' EXIT
status=0
wine "$@" >"$printed" 2>&1 || status=$?
cat "$printed"
exit "$status"
