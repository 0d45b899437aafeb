#!/bin/sh
# upgrading.sh COMPILER CHECKOUT FOLDER: of docs/upgrading.md every block named *_0_2.cpp is refused by the compiler, and
# its *_0_3.cpp compiles.
#
# Leaves in FOLDER the README's code of 0.2.0 (tests/contract/upgrading/code), in "0.2" as it was and in "0.3" with the
# change that the page asks for.
set -eu
compiler=$1 checkout=$2 folder=$3
here=$checkout/tests/contract
sh "$here/extract_readme.sh" "$checkout/docs/upgrading.md" "$folder/page"

bad=0
pairs=0
compiles() { "$compiler" -std=c++17 -fsyntax-only -Wall -Wextra -Werror -I "$checkout/core/include" "$1" >"$folder/log" 2>&1; }
for before in "$folder"/page/*_0_2.cpp; do
  after=${before%_0_2.cpp}_0_3.cpp
  pairs=$((pairs + 1))
  if compiles "$before"; then echo "${before##*/} compiles: docs/upgrading.md says that it does not" && bad=$((bad + 1)); fi
  compiles "$after" || { cat "$folder/log" && echo "${after##*/} does not compile" && bad=$((bad + 1)); }
done
[ "$pairs" -gt 0 ]

rm -rf "$folder/0.2" "$folder/0.3"
cp -R "$here/upgrading/code" "$folder/0.2"
cp -R "$here/upgrading/code" "$folder/0.3"
change='find_package(crankloop 0.2 REQUIRED)'
for said in "$change" 'find_package(crankloop 0.3 REQUIRED)'; do
  grep -qF "$said" "$checkout/docs/upgrading.md" || { echo "docs/upgrading.md does not say $said" && bad=$((bad + 1)); }
done
grep -qF "$change" "$folder/0.2/CMakeLists.txt"
sed 's/find_package(crankloop 0\.2 REQUIRED)/find_package(crankloop 0.3 REQUIRED)/' "$folder/0.2/CMakeLists.txt" >"$folder/0.3/CMakeLists.txt"
[ "$bad" -eq 0 ]
