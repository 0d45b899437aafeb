#!/bin/sh
# tidy.sh check   fails when what clang-tidy finds in core and port is not what the table of docs/safety.md lists: rule and count
# tidy.sh renew   writes the counts of that table anew; reasons stay, and a rule without one gets none
# tidy.sh find    prints every finding
# With --report behind, of the last run.
#
# The checks hicpp-*, cert-* and bugprone-* of clang-tidy 14, and misc-no-recursion, on each translation unit of core and
# port that preset clang compiles, on FMI's functions, and on tests/tidy_scenes.cpp. A finding in a header counts once,
# however many units include it. Last line: "N passed, M failed"; by another clang-tidy it compares no counts.
set -eu
CDPATH='' cd -- "$(dirname -- "$0")/.."
what=${1:-}
case $what:${2:-} in
  check: | renew: | find: | check:--report | renew:--report | find:--report) ;;
  *) sed -n '2,/^[^#]/s/^# \{0,1\}//p' tests/tidy.sh >&2 && exit 2 ;;
esac
version=14
page=docs/safety.md
build=build/clang
work=build/tidy
jobs=$(nproc 2>/dev/null || echo 1)

run_all() {
  rm -rf "$work"
  mkdir -p "$work"
  cmake --preset clang >"$work/configure.log" 2>&1
  {
    sed -n 's/^ *"file": "\(.*\)".*/\1/p' $build/compile_commands.json | sort -u |
      grep -E "^$PWD/(core|port)/|/commands/fmu/exports[.]cpp\$"
    echo "$PWD/tests/tidy_scenes.cpp"
  } >"$work/units"
  # tidy UNIT: what clang-tidy finds there. The unit that is in no compile database has its flags here.
  cat >"$work/tidy" <<END
#!/bin/sh
case \$1 in
  */tidy_scenes.cpp) set -- "\$1" -- -std=c++17 -ffp-contract=off "-I$PWD/core/include" ;;
  *) set -- "\$1" -p $build ;;
esac
exec clang-tidy --quiet --header-filter="^$PWD/(core|port)/" --checks='-*,hicpp-*,cert-*,bugprone-*,misc-no-recursion' "\$@" \\
  >"$work/\$(echo "\$1" | tr / _).found" 2>>"$work/stderr"
END
  xargs -P "$jobs" -n 1 sh "$work/tidy" <"$work/units" || :
}
[ "${2:-}" = --report ] || run_all

failed=0
if [ "$(find "$work" -name '*.found' | wc -l)" -ne "$(wc -l <"$work/units")" ] || grep -hE '(^error|: error): ' "$work"/*.found; then
  echo 'not every unit compiles' && failed=1
fi
# "RULE file:line:column: what", each once. A rule with several names has them all: "cert-oop54-cpp,bugprone-...".
sed -E 's#[a-z_]+/[.][.]/##' "$work"/*.found | sed -nE "s#^$PWD/((core|port)/[^ ]*): warning: (.*) \[([a-z0-9.,-]*)\]\$#\4 \1: \3#p" | sort -u |
  awk '!seen[$1 " " $2]++' >"$work/findings"
if [ "$what" = find ]; then
  cat "$work/findings"
  exit $failed
fi
cut -d ' ' -f 1 "$work/findings" | uniq -c | awk '{ print $2 " " $1 }' >"$work/counts"

found=$(clang-tidy --version | sed -n 's/.*LLVM version \([0-9]*\).*/\1/p')
compared=1
if [ "$found" != $version ]; then
  echo "skipped tidy.findings: clang-tidy $found, docs/safety.md has the counts of $version"
  compared=0
else
  # The table stands between the two marks; its rows are "| `RULE` | COUNT | reason |".
  awk -v counts="$work/counts" '
    BEGIN { while ((getline line <counts) > 0) { split(line, word, " "); count[word[1]] = word[2] } }
    /^<!-- tidy end -->/ {
      inside = 0
      for (rule in count) if (!(rule in listed)) print "| `" rule "` | " count[rule] " | |" | "sort"
      close("sort")
    }
    inside && /^\| `/ {
      split($0, cell, "`")
      listed[cell[2]] = 1
      if (!(cell[2] in count)) next
      sub(/\| [0-9]+ \|/, "| " count[cell[2]] " |")
    }
    { print }
    /^<!-- tidy begin/ { inside = 1 }' $page >"$work/page"
  # shellcheck disable=SC2016  # code in Markdown
  if [ "$what" = renew ]; then
    cp "$work/page" $page
  elif ! diff $page "$work/page"; then
    echo "$page: the lines with < are not what clang-tidy finds; tests/tidy.sh renew, and give reasons" && failed=$((failed + 1))
  elif grep -nE '^\| `[^`]*` \| [0-9]+ \| *\|' $page; then
    echo "$page: a deviation has no reason" && failed=$((failed + 1))
  fi
fi
echo "$((1 + compared - failed)) passed, $failed failed"
[ "$failed" -eq 0 ]
