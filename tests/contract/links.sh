#!/bin/sh
# links.sh CHECKOUT: every relative link in README.md, CHANGELOG.md and docs leads to a file or folder, and every anchor
# to a heading.
#
# Anchors are those that GitHub makes of headings: lower case, spaces as dashes, other punctuation dropped, -1, -2 for
# the second and third heading of the same text. Code, in blocks or between backticks, holds no links and no headings.
set -eu
cd "$1"
export LC_ALL=C

prose_of() { awk '/^ *(```|~~~)/ { fenced = !fenced; next } !fenced' "$1"; }
# links_in FILE: the targets of its links and images, one a line. A code span may go over a line's end, so by paragraphs.
links_in() {
  prose_of "$1" | awk -v RS= '
    {
      gsub(/`[^`]*`/, "")
      while (match($0, /\]\([^()]*\)|\n\[[^]\n]*\]:[ \t]*[^ \t\n]+|^\[[^]\n]*\]:[ \t]*[^ \t\n]+/)) {
        target = substr($0, RSTART, RLENGTH)
        $0 = substr($0, RSTART + RLENGTH)
        if (!sub(/^\]\([ \t\n]*/, "", target)) sub(/^\n?\[[^]\n]*\]:[ \t]*/, "", target)
        sub(/[ \t\n]+["\047].*$/, "", target)  # a title
        gsub(/[ \t\n)<>]/, "", target)
        print target
      }
    }'
}
# anchors_of FILE: one a line.
anchors_of() {
  prose_of "$1" | awk '
    /^#+ / {
      sub(/^#+ +/, "")
      sub(/ +#* *$/, "")
      while (match($0, /\]\([^()]*\)/)) $0 = substr($0, 1, RSTART - 1) substr($0, RSTART + RLENGTH)
      anchor = tolower($0)
      gsub(/[^a-z0-9 _-]/, "", anchor)
      gsub(/ /, "-", anchor)
      print anchor (anchor in seen ? "-" seen[anchor] : "")
      ++seen[anchor]
    }'
}

checked=0
bad=0
refuse() {
  echo "$1: $2 $3"
  bad=$((bad + 1))
}
for document in README.md CHANGELOG.md $(find docs -name '*.md' | sort); do
  while read -r target; do
    case $target in '' | [a-z]*:*) continue ;; esac  # nothing; https: and the like
    checked=$((checked + 1))
    path=${target%%#*}
    file=$document
    [ -z "$path" ] || file=$(dirname "$document")/$path
    if [ ! -e "$file" ]; then
      refuse "$document" "$target" 'leads to no file'
    elif [ "$path" != "$target" ] && ! anchors_of "$file" | grep -qxF -e "${target#*#}"; then
      refuse "$document" "$target" 'leads to no heading'
    fi
  done <<END
$(links_in "$document")
END
done
[ "$checked" -gt 0 ] || refuse links.sh "$1" 'has no links'
[ "$bad" -eq 0 ]
