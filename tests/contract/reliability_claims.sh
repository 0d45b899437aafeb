#!/bin/sh
# reliability_claims.sh CHECKOUT: every run in docs/reliability.md names its command, date, commit and the hash of the
# core that it holds for, and says so where today's core is another.
#
# Where the checkout has the commit, the hash is that of the commit's core. Exit status 77 without git.
set -eu
cd "$1"
git rev-parse HEAD >/dev/null 2>&1 || { echo 'skipped: no git checkout'; exit 77; }
core=$(git rev-parse --short=12 HEAD:core)
page=docs/reliability.md
runs=$(mktemp)
trap 'rm -f "$runs"' EXIT
awk '/^<!-- runs begin/ { inside = 1 } /^<!-- runs end/ { inside = 0 } inside && /^[|]/ && ++row > 2 { print }' $page >"$runs"
[ -s "$runs" ] || { echo "$page has no table of runs" && exit 1; }

bad=0
complain() { echo "$page: $1: $2" && bad=$((bad + 1)); }
while IFS= read -r row; do
  name=$(echo "$row" | sed 's/^| \([^|]*\) |.*/\1/')
  # shellcheck disable=SC2016  # code in Markdown
  form='^\| [^|]+ \| `[^`]+` \| [^|]+ \| 20[0-9]{2}-[0-9]{2}-[0-9]{2} \| [0-9a-f]{7,40} \| [0-9a-f]{12}(, changed since)? \|$'
  echo "$row" | grep -qE "$form" || { complain "$name" 'not run, command, result, date, commit, core' && continue; }
  commit=$(echo "$row" | sed 's/.* | \([0-9a-f]*\) | [^|]* |$/\1/')
  claim=$(echo "$row" | sed 's/.* | \([^|]*\) |$/\1/')
  tree=${claim%%,*}
  case $tree:$claim in
    "$core":*since) complain "$name" "holds for today's core, and says that it does not" ;;
    "$core":*) ;;
    *since) ;;
    *) complain "$name" "core is $core today: tests/reliability.sh --age" ;;
  esac
  its=$(git rev-parse -q --verify --short=12 "$commit:core" 2>/dev/null) || continue
  [ "$its" = "$tree" ] || complain "$name" "the core of $commit is $its, not $tree"
done <"$runs"

# A claim elsewhere would have no hash.
awk '/^<!-- runs begin/ { inside = 1 } /^<!-- runs end/ { inside = 0 } !inside && /20[0-9][0-9]-[0-9][0-9]-[0-9][0-9]/ { print FILENAME ":" FNR ": a date outside the table of runs"; found = 1 } END { exit found }' $page || bad=$((bad + 1))
[ "$bad" -eq 0 ]
