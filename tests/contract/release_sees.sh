#!/bin/sh
# release_sees.sh CHECKOUT: tools/release archives what is committed, the same bytes each time, and nothing when something
# is amiss. Tried on a small project whose two commands end at once.
set -eu
command -v git >/dev/null || { echo "there is no git" && exit 77; }
folder="$(mktemp -d)/a checkout"
trap 'rm -rf "${folder%/*}"' EXIT
mkdir -p "$folder/tools"
cp "$1/tools/release" "$1/tools/common.sh" "$folder/tools"
cd "$folder"
export GIT_CONFIG_GLOBAL=/dev/null GIT_CONFIG_NOSYSTEM=1
commit() { git add -A && git -c user.name=a -c user.email=a@b -c commit.gpgsign=false commit -q -m "$1"; }
fail() { echo "$*" >&2 && exit 1; }
archive=build/crankloop-1.2.3.tar.gz

# refuses WHAT [argument...]: says WHAT, and leaves no archive.
refuses() {
  what=$1
  shift
  if tools/release "$@" >../said 2>&1; then fail "released, though: $what"; fi
  grep -q "$what" ../said || fail "does not say '$what' but: $(cat ../said)"
  [ ! -e "$archive" ] || fail "an archive is left, though: $what"
}

echo 'project(crankloop VERSION 1.2.3 DESCRIPTION "x")' >CMakeLists.txt
printf '# Changelog\n\n## 1.2.3, unreleased\n' >CHANGELOG.md
echo /build/ >.gitignore
for command in demo check; do printf '#!/bin/sh\ntest -e CMakeLists.txt && test ! -e .git\n' >tools/$command; done
chmod +x tools/*

refuses 'no git checkout'
git init -q
commit first
refuses "CHANGELOG.md has no line '## 1.2.3, YYYY-MM-DD'"
sed -i 's/unreleased/2026-01-31/' CHANGELOG.md
refuses 'not committed'
commit dated
refuses 'takes no arguments' --help

tools/release >/dev/null
tar tzf "$archive" | grep -q -x crankloop-1.2.3/tools/check || fail "the archive lacks what is committed"
if tar tzf "$archive" | grep -q '/build/'; then fail "the archive has what is not committed"; fi
mv "$archive" build/first.tar.gz
tools/release >/dev/null
cmp build/first.tar.gz "$archive"

rm "$archive"
echo 'exit 1' >>tools/check
commit 'a command that fails'
refuses 'tools/check does not pass'
