#!/bin/sh
# install_has.sh PREFIX COMPILER
# What `cmake --install` brings besides the library for CMake: engine files that run, documents, a manual page that tells every command, and a
# library that pkg-config finds, wherever the install has been moved to.
set -eu
prefix=$1 compiler=$2
fail() { echo "$*" >&2 && exit 1; }

for file in share/crankloop/engines/diesel_495.ini share/crankloop/engines/ohc_125.ini share/doc/crankloop/README.md \
  share/doc/crankloop/docs/model.md share/doc/crankloop/LICENSE share/man/man1/crankloop.1; do
  [ -s "$prefix/$file" ] || fail "$file is not installed"
done
"$prefix/bin/crankloop" show "$prefix/share/crankloop/engines/ohc_125.ini" >/dev/null

page=$prefix/share/man/man1/crankloop.1
"$prefix/bin/crankloop" --help | sed -n 's/^  \([a-z]*\)   *\(.*\)/\1 \2/p' | while read -r command summary; do
  [ "$(sed 's/\\-/-/g' "$page" | grep -A 1 -x "\.B $command" | tail -n 1)" = "$summary" ] ||
    fail "docs/crankloop.1 does not say of $command: $summary"
done

if ! command -v pkg-config >/dev/null; then exit 0; fi
moved=$(mktemp -d)
trap 'rm -rf "$moved"' EXIT
cp -R "$prefix/." "$moved/here"
pc=$(find "$moved" -name crankloop.pc)
cat >"$moved/main.cpp" <<'CPP'
#include <crankloop/crankloop.hpp>
int main() { return crankloop::validate(crankloop::Crank{}).ok() ? 1 : 0; }  // a function of the library; a crank of no size
CPP
flags=$(PKG_CONFIG_PATH=${pc%/*} pkg-config --cflags --libs crankloop)
# shellcheck disable=SC2086  # flags is a list of words
"$compiler" -std=c++17 "$moved/main.cpp" $flags -o "$moved/main"
"$moved/main"
