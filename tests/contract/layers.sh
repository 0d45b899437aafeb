#!/bin/sh
# layers.sh CHECKOUT: no file of a lower layer includes one of a higher one.
#
# Core knows nothing of ports, tools and tests. The program's folders stand in the order below, each on those
# before it; files beside the folders are either for all of them or one for each command, and a command may include all.
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

for folder in port tools tests lab gtest; do
  if grep -rnE "^#include [\"<](\.\./)*$folder/" core; then refuse core "$folder" "is no part of it"; fi
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
