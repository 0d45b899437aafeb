#!/bin/sh
# forgotten_member_is_refused.sh COMPILER CORE_DIR C_INTERFACE_DIR
# Each record of the tables with one more member does not compile where all members are gone through
# (tabulate/table_members.hpp), so none can be left out of what is printed for flash. Nor does a definition with one
# more field than its each_field() lists compile where the tables' fingerprint is made, nor one with a field that is
# listed and crankloop.h lacks where C's definition is copied; there four structs stand for all that its template
# copies. As they are all of them do compile.
set -eu
compiler=$1 core=$2 c_interface=$3
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cp -R "$core/include/crankloop" "$folder"
# Each record's list of members by itself: one that is wrong hides no other.
{
  echo '#include <crankloop/tabulate/table_members.hpp>'
  echo 'namespace crankloop::detail {'
  sed -n -e 's/^CRANKLOOP_MEMBERS(\([A-Z][A-Za-z]*\),.*/void go(\1\& x) { members(x); }/p' \
    -e 's/^CRANKLOOP_MEMBERS_OF(\([A-Z][A-Za-z]*\),.*/void go(\1<float>\& x) { members(x); }/p' "$folder/crankloop/tabulate/table_members.hpp"
  echo '}'
} >"$folder/records.cpp"
every_error=  # clang++ stops after 20
case $("$compiler" --version) in *clang*) every_error=-ferror-limit=0 ;; esac
# compiles FILE
compiles() { "$compiler" -std=c++17 -fsyntax-only $every_error -I "$folder" -I "$c_interface/include" "$1" 2>&1; }

bad=0 structs=0

# All of them in one go: for each struct the compiler says into how many members it decomposes.
records=$(sed -n 's/^CRANKLOOP_MEMBERS[A-Z_]*(\([A-Z][A-Za-z]*\),.*/\1/p' "$folder/crankloop/tabulate/table_members.hpp")
said=$(compiles "$folder/records.cpp") || { bad=$((bad + 1)) && printf 'as they are the records do not compile:\n%s\n' "$said"; }
cp -R "$folder/crankloop/tables" "$folder/as_they_are"
for record in $records; do sed -i "s/^struct $record {/&\n  unsigned added;/" "$folder"/crankloop/tables/*.hpp; done
said=$(compiles "$folder/records.cpp" || true)
for record in $records; do
  structs=$((structs + 1))
  printf '%s' "$said" | grep -Eq "[': ]$record(<float>)?[^A-Za-z]* decomposes" ||
    { bad=$((bad + 1)) && echo "compiles with one more member: $record"; }
done
rm -r "$folder/crankloop/tables" && mv "$folder/as_they_are" "$folder/crankloop/tables"

listed='' # a command of sed for what else the struct gets
# each_refused FILE MESSAGE HEADERS STRUCT...: FILE compiles; with one more member of any of the structs it does not,
# and the compiler says MESSAGE.
each_refused() {
  file=$1 message=$2 headers=$3
  shift 3
  said=$(compiles "$file") || { bad=$((bad + 1)) && printf 'as it is %s does not compile:\n%s\n' "$file" "$said"; }
  for struct in "$@"; do
    structs=$((structs + 1))
    header=$(grep -lE "^struct $struct \{" "$folder/crankloop/$headers"/*.hpp)
    cp "$header" "$folder/as_it_is"
    sed -i "/^struct $struct {/,/^};/ { s/^struct .*/&\n  unsigned added;/; $listed; }" "$header"
    if said=$(compiles "$file"); then
      bad=$((bad + 1)) && echo "compiles with one more member: $struct"
    elif ! printf '%s' "$said" | grep -Eq "$message"; then
      bad=$((bad + 1)) && printf '%s is refused, but not for its members: %s\n' "$struct" "$said"
    fi
    cp "$folder/as_it_is" "$header"
  done
}

listing=$(cat "$folder"/crankloop/define/*.hpp | awk '/^struct / { name = $2 } /void each_field\(/ { print name }')
# shellcheck disable=SC2086  # lists of words
{
  each_refused "$core/src/tabulate/fingerprint.cpp" 'each_field|all but the trigger wheels|structured binding|decomposes' define $listing
  listed='s/void each_field(.*/&\n    CRANKLOOP_FIELD(1, x, added);/'
  each_refused "$c_interface/definition.cpp" '.added|decomposes' define EngineDefinition CamContact Walls PortOfTrain
}
echo "$structs structs, $bad bad"
[ "$structs" -gt 35 ] && [ "$bad" -eq 0 ]
