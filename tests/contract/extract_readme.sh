#!/bin/sh
# extract_readme.sh README FOLDER NAME...
# Writes the README's code blocks whose first line is a comment with a file's name ("// main.cpp", "# CMakeLists.txt")
# to that file in FOLDER. Every NAME must be among them.
set -eu
readme=$1 folder=$2
shift 2

rm -rf "$folder"
mkdir -p "$folder"
awk -v folder="$folder" '
  /^```/ { inside = !inside; first = inside; file = ""; next }
  first && /^(\/\/|#) [A-Za-z0-9_]+\.[a-z]+$/ { file = folder "/" $2 }
  inside && file != "" { print > file }
  { first = 0 }
' "$readme"

for name in "$@"; do
  [ -s "$folder/$name" ] || { echo "$readme has no code block that begins with a comment line naming $name" && exit 1; }
done
