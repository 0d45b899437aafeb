#!/bin/sh
# layers.sh CHECKOUT: no file of a lower layer includes one of a higher one.
#
# Core includes itself and the standard library. port/c and port/fmi stand on core and know nothing of each other. The
# rooms of tools/crankloop stand in the order below, each on those before it, and main.cpp on all. Of the commands, each a
# file or a folder, none includes another's. The laboratory may include all but commands, of which only bench and stress
# include it.
set -eu
cd "$1"

rooms='files report engine_file command_line loops signals engine_report commands main.cpp'

bad=0
refuse() {
  echo "$1 includes $2, which $3"
  bad=$((bad + 1))
}
# floor_of PATH-BELOW-tools/crankloop: the place of its room in the order.
floor_of() {
  floor=1
  for room in $rooms; do
    [ "${1%%/*}" != "$room" ] || return 0
    floor=$((floor + 1))
  done
  refuse layers.sh "$1" 'has no room'
}
# command_of PATH-BELOW-tools/crankloop: the name of a command's file or folder.
command_of() {
  command=${1#commands/}
  command=${command%%/*}
  command=${command%%.*}
}
# includes_in FOLDER...: lines "file included", the included as written.
includes_in() { grep -rHE '^#include ["<]' "$@" --include='*.[hc]pp' --include='*.h' --include='*.in[cl]' | sed -E 's/:#include ["<]([^">]+)[">].*/ \1/'; }
# stands_on FOLDER ROOT...: what FOLDER includes is its own, of one of the roots, or of the standard library.
stands_on() {
  folder=$1
  shift
  while read -r file included; do
    found=
    for root in "${file%/*}" "$@"; do
      [ ! -f "$root/$included" ] || { found=$root/$included && break; }
    done
    case $found in *../*) found=$(realpath --relative-to=. "$found") ;; esac
    case $found:$included in
      "$folder"/* | core/*) ;;
      ?*:* | :*/*) refuse "$file" "$included" "$folder does not stand on" ;;
    esac
  done <<END
$(includes_in "$folder")
END
}
stands_on core core/include core/src
stands_on port/c port/c/include core/include
stands_on port/fmi port/fmi/include core/include
elsewhere='^[^#]*(port|tools|tests)/'  # in what CMake reads
for file in $(grep -rlE "$elsewhere" core --include=CMakeLists.txt --include='*.cmake'); do
  refuse "$file" "$(grep -nE -m 1 "$elsewhere" "$file")" 'core does not stand on'
done

all=$(includes_in tools)
[ -n "$all" ]
for file in $(find tools/crankloop -name '*.[hc]*' -type f); do floor_of "${file#tools/crankloop/}"; done
while read -r file included; do
  for included in "${file%/*}/$included" "tools/$included"; do
    [ ! -f "$included" ] || break
  done
  [ -f "$included" ] || continue  # core's, a port's or the system's
  while :; do  # folder/../ goes nowhere
    case $included in */../*) ;; *) break ;; esac
    before=${included%%/../*}
    included=${before%/*}/${included#*/../}
  done
  case $file:$included in
    tools/lab/*:tools/crankloop/commands/* | tools/lab/*:tools/crankloop/main.cpp) refuse "$file" "$included" 'is of a command' ;;
    tools/lab/*) ;;
    tools/crankloop/commands/bench.cpp:tools/lab/* | tools/crankloop/commands/stress.cpp:tools/lab/*) ;;
    *:tools/lab/*) refuse "$file" "$included" 'is of the laboratory' ;;
    *)
      floor_of "${included#tools/crankloop/}"
      lower=$floor
      floor_of "${file#tools/crankloop/}"
      [ "$lower" -le "$floor" ] || refuse "$file" "$included" 'stands above it'
      case $file:$included in
        tools/crankloop/commands/*:tools/crankloop/commands/*)
          command_of "${file#tools/crankloop/}"
          own=$command
          command_of "${included#tools/crankloop/}"
          [ "$own" = "$command" ] || refuse "$file" "$included" 'is of another command'
          ;;
      esac
      ;;
  esac
done <<END
$all
END
[ "$bad" -eq 0 ]
