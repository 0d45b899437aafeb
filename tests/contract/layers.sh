#!/bin/sh
# layers.sh CHECKOUT: no file of a lower layer includes one of a higher one.
#
# Core includes itself and the standard library. port/c and port/fmi stand on core and know nothing of each other. The
# program's folders stand in the order below, each on those before it; files beside the folders are either for all of
# them or one for each command, and a command may include all.
# The laboratory may include all but commands, of which only bench and stress include it.
set -eu
cd "$1"

layers='report engine_file signals valve run engine_report redline map free live fmu new'
for_all='arguments csv error files_in_use machine number output_file progress results run_limits summary table_file text_file tick_probe units with_real words free_orders'

bad=0
refuse() {
  echo "$1 includes $2, which $3"
  bad=$((bad + 1))
}
in_list() { case " $2 " in *" $1 "*) return 0 ;; *) return 1 ;; esac; }
# place_of PATH-BELOW-tools/crankloop: 0 for what is for all, then the folders, 99 for commands.
place_of() {
  case $1 in
    */*) place=1 && for layer in $layers; do [ "${1%%/*}" = "$layer" ] && return || place=$((place + 1)); done && refuse "layers.sh" "$1" 'has no layer' ;;
    *) if in_list "${1%.*}" "$for_all"; then place=0; else place=99; fi ;;
  esac
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

found=$(includes_in tools)
[ -n "$found" ]
while read -r file included; do
  for included in "$(dirname "$file")/$included" "tools/$included"; do
    [ ! -f "$included" ] || break
  done
  [ -f "$included" ] || continue  # core's, a port's or the system's
  case $included in *../*) included=$(realpath --relative-to=. "$included") ;; esac
  case $file:$included in
    tools/lab/*:tools/lab/* | tools/crankloop/bench.cpp:tools/lab/* | tools/crankloop/stress.cpp:tools/lab/*) continue ;;
    *:tools/lab/*) refuse "$file" "$included" 'is of the laboratory' && continue ;;
  esac
  place_of "${included#tools/crankloop/}"
  lower=$place
  case $file in
    tools/lab/*) place=98 ;;
    *) place_of "${file#tools/crankloop/}" ;;
  esac
  [ "$lower" -le "$place" ] || refuse "$file" "$included" 'stands above it'
done <<END
$found
END
[ "$bad" -eq 0 ]
