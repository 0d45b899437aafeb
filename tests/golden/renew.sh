#!/bin/sh
# renew.sh WHY: writes all golden runs anew, on purpose, with a line in CHANGELOG.md that says WHY; then shows what
# changed.
set -eu
if [ $# -ne 1 ] || [ -z "$1" ]; then
  echo "usage: $0 WHY" >&2
  exit 2
fi
CDPATH='' cd -- "$(dirname -- "$0")/../.."
cmake --preset check
cmake --build --preset check --target crankloop_golden_tests --parallel 2
rm -rf tests/golden/runs  # and with it runs that are no more
build/check/tests/crankloop_golden_tests --gtest_brief=1 --renew "$1"
git --no-pager diff --stat -- tests/golden CHANGELOG.md
