#!/bin/sh
# renew_hashes.sh SELF_CHECK: writes golden_hashes.inc anew from what the self-check built on this machine answers.
# `cmake --build --preset check --target renew_target_hashes` calls it. Changed hashes mean changed results:
# CHANGELOG.md has to say so.
set -eu
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
{ "$1" 2>&1 || true; } | sed -n 's/^golden \([a-z0-9_]*\) \(0x[0-9A-F]*\)$/{"\1", \2},/p' >"$here/golden_hashes.inc.new"
[ -s "$here/golden_hashes.inc.new" ] || { echo "$1 answers no hashes" >&2 && exit 1; }
mv "$here/golden_hashes.inc.new" "$here/golden_hashes.inc"
