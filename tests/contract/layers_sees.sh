#!/bin/sh
# layers_sees.sh CHECKOUT: what layers.sh refuses, tried on a copy with one line more.
set -eu
layers=$1/tests/contract/layers.sh
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
(cd "$1" && find core port tools -name '*.[hc]*' -o -name '*.in[cl]' -o -name 'CMakeLists.txt') >"$folder/files"
mkdir "$folder/copy"
tar -c -C "$1" -T "$folder/files" | tar -x -C "$folder/copy"
sh "$layers" "$folder/copy" || { echo "as it is the copy is refused" && exit 1; }

bad=0
# refuses FILE LINE: layers.sh names FILE once LINE stands in it.
refuses() {
  cp "$folder/copy/$1" "$folder/as_it_is"
  echo "$2" >>"$folder/copy/$1"
  if said=$(sh "$layers" "$folder/copy"); then
    bad=$((bad + 1)) && echo "$1 may have the line $2"
  elif ! printf '%s' "$said" | grep -q "^$1 includes "; then
    bad=$((bad + 1)) && printf '%s with the line %s is refused, but not for it: %s\n' "$1" "$2" "$said"
  fi
  mv "$folder/as_it_is" "$folder/copy/$1"
}
refuses core/include/crankloop/state.hpp '#include <crankloop/fmi/kept.hpp>'
refuses core/include/crankloop/variables.hpp '#include <crankloop/crankloop.h>'
refuses core/src/tick/whole.cpp '#include "../../../port/c/run_time_tables.hpp"'
refuses core/src/define/gas.cpp '#include "tests/support/units.hpp"'
refuses core/CMakeLists.txt 'include(../port/c/CrankloopCInterface.cmake)'
refuses port/fmi/include/crankloop/fmi/kept.hpp '#include <crankloop/crankloop.h>'
refuses port/c/definition.cpp '#include "../../tools/crankloop/files/error.hpp"'
refuses tools/crankloop/files/csv.cpp '#include "crankloop/command_line/summary.hpp"'
refuses tools/crankloop/report/page.hpp '#include "../engine_file/engine_file.hpp"'
refuses tools/crankloop/engine_file/gas_order.hpp '#include "../command_line/arguments.hpp"'
refuses tools/crankloop/loops/run_loop.hpp '#include "../engine_report/engine_report.hpp"'
refuses tools/crankloop/commands/balance.cpp '#include "run/run_signals.hpp"'
refuses tools/crankloop/commands/map/map.cpp '#include "../run/free_loop.hpp"'
refuses tools/crankloop/commands/show.cpp '#include "lab/bench/row.hpp"'
refuses tools/lab/bench/row.cpp '#include "crankloop/commands/valve/valve_plot.hpp"'
[ "$bad" -eq 0 ]
