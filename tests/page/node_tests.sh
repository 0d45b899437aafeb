#!/bin/sh
# node_tests.sh FOLDER: the page's modules by Node's own runner. Exit status 77, "skipped", where there is no Node.
set -eu
command -v node >/dev/null || exit 77
exec node --test "$1"
