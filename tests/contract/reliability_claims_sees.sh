#!/bin/sh
# reliability_claims_sees.sh CHECKOUT: reliability_claims.sh sees what is wrong with a page's table of runs, in a
# repository made for it. Exit status 77 without git.
set -eu
command -v git >/dev/null || exit 77
check=$1/tests/contract/reliability_claims.sh
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
unset GIT_DIR GIT_WORK_TREE GIT_INDEX_FILE
cd "$folder"
save() { git add . && git -c user.name=a -c user.email=a@b -c commit.gpgsign=false commit -qm a; }
git init -q .
mkdir core docs
echo 1 >core/tick
save
first=$(git rev-parse --short=12 HEAD) first_core=$(git rev-parse --short=12 HEAD:core)
echo 2 >core/tick
save
second=$(git rev-parse --short=12 HEAD) second_core=$(git rev-parse --short=12 HEAD:core)

bad=0
# says STATUS WORDS ROW: how the check ends on a page with that row, and what it says.
says() {
  printf '<!-- runs begin -->\n\n| run | command | result | date | commit | core |\n| --- | --- | --- | --- | --- | --- |\n%s\n\n<!-- runs end -->\n%s\n' \
    "$3" "${4:-}" >docs/reliability.md
  status=0
  said=$(sh "$check" "$folder") || status=$?
  case $status:$said in "$1":*"$2"*) return ;; esac
  printf 'expected %s and "%s", got %s and "%s" of: %s\n' "$1" "$2" "$status" "$said" "$3"
  bad=$((bad + 1))
}
# row COMMIT CORE: a whole row.
row() { echo "| soak | \`ctest -R Soak\` | 10 ticks | 2026-01-02 | $1 | $2 |"; }
says 0 '' "$(row "$second" "$second_core")"
says 0 '' "$(row "$first" "$first_core, changed since")"
says 0 '' "$(row 0123456789ab "$first_core, changed since")"  # a commit that the checkout does not have
says 1 'reliability.sh --age' "$(row "$first" "$first_core")"
says 1 'says that it does not' "$(row "$second" "$second_core, changed since")"
says 1 "the core of $first is $first_core" "$(row "$first" "$second_core")"
says 1 'not run, command' '| soak | 10 ticks | 2026-01-02 | 0123456789ab | 0123456789ab |'
says 1 'not run, command' "| soak | \`a\` | 10 ticks | lately | $second | $second_core |"
says 1 'no table of runs' ''
says 1 'a date outside' "$(row "$second" "$second_core")" 'Measured on 2026-01-02.'
[ "$bad" -eq 0 ]
