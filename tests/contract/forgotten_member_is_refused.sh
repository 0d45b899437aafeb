#!/bin/sh
# forgotten_member_is_refused.sh COMPILER INCLUDE_DIR
# Each record of the tables with one more member does not compile where all members are gone through (tabulate/table_members.hpp), so none
# can be left out of what is printed for flash. The records as they are do compile: all that the sections are made of are in that list.
set -eu
compiler=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cp -R "$2/crankloop" "$folder"
cat >"$folder/all.cpp" <<'END'
#include <crankloop/tabulate/table_members.hpp>
#include <crankloop/tabulate/tabulate.hpp>
using namespace crankloop;
template <class T>
void go_through(const T& x) {
  if constexpr (std::is_array_v<T>) {
    go_through(x[0]);
  } else if constexpr (std::is_class_v<T>) {
    std::apply([](const auto&... member) { (go_through(member), ...); }, members(x));
  }
}
template <class Real>
void all(const TableTargets<Real>& tables) {
  sections([&](auto section) { go_through(*section.in(tables)); });
}
template void all(const TableTargets<float>&);
END
compiles() { "$compiler" -std=c++17 -fsyntax-only -I "$folder" "$folder/all.cpp" 2>&1; }

bad=0 records=0
said=$(compiles) || { bad=1 && printf 'the records as they are do not compile:\n%s\n' "$said"; }
listed=$(sed -n 's/^CRANKLOOP_MEMBERS[A-Z_]*(\([A-Z][A-Za-z]*\),.*/\1/p' "$folder/crankloop/tabulate/table_members.hpp")
for record in $listed; do
  records=$((records + 1))
  header=$(grep -lE "^struct $record \{" "$folder"/crankloop/tick/*.hpp)
  cp "$header" "$folder/as_it_is"
  sed -i "s/^struct $record {/&\n  unsigned added;/" "$header"
  if said=$(compiles); then
    bad=$((bad + 1)) && echo "compiles with one more member: $record"
  elif ! printf '%s' "$said" | grep -Eq 'structured binding|decomposes'; then
    bad=$((bad + 1)) && printf '%s is refused, but not for its members: %s\n' "$record" "$said"
  fi
  cp "$folder/as_it_is" "$header"
done
echo "$records records, $bad bad"
[ "$records" -gt 20 ] && [ "$bad" -eq 0 ]
