#!/bin/sh
# in_browser.sh SCRIPT [ARGUMENTS]: a script of Node that drives Chromium. Exit status 77, "skipped", where there is no
# Node or no Chromium.
set -eu
command -v node >/dev/null || exit 77
exec node "$@"
