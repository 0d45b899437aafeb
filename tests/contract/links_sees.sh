#!/bin/sh
# links_sees.sh CHECKOUT: what links.sh refuses and what it accepts, tried on a small tree with one line more.
set -eu
links=$1/tests/contract/links.sh
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
tree=$folder/tree
mkdir -p "$tree/docs/decisions" "$tree/core"
echo 'int x;' >"$tree/core/x.hpp"
cat >"$tree/README.md" <<'END'
# A title

[The guide](docs/guide.md), [its second step](docs/guide.md#step-1), [the source](core/x.hpp), [a folder](core).
END
cat >"$tree/docs/guide.md" <<'END'
# Guide: first, then `next_step()`

## Step

## Step

```sh
# Only a comment
```
END
printf '# Changes\n' >"$tree/CHANGELOG.md"
printf '# 0001\n' >"$tree/docs/decisions/0001.md"
sh "$links" "$tree" || { echo "as it is the tree is refused" && exit 1; }

bad=0
# with FILE LINE: what links.sh says once LINE stands in FILE, after an empty line.
with() {
  cp "$tree/$1" "$folder/as_it_is"
  printf '\n%s\n' "$2" >>"$tree/$1"
  accepted=yes
  said=$(sh "$links" "$tree") || accepted=no
  mv "$folder/as_it_is" "$tree/$1"
}
# refuses FILE LINE TARGET: it names FILE and TARGET.
refuses() {
  with "$1" "$2"
  if [ "$accepted" = yes ]; then
    bad=$((bad + 1)) && echo "$1 may have the line $2"
  elif ! printf '%s' "$said" | grep -qF "$1: $3 leads to no "; then
    bad=$((bad + 1)) && printf '%s with the line %s is refused, but not for it: %s\n' "$1" "$2" "$said"
  fi
}
accepts() {
  with "$1" "$2"
  [ "$accepted" = yes ] || { bad=$((bad + 1)) && printf '%s may not have the line %s: %s\n' "$1" "$2" "$said"; }
}
refuses README.md '[gone](docs/gone.md)' docs/gone.md
refuses README.md 'Two: [here](core/x.hpp) and [gone](core/y.hpp "a title").' core/y.hpp
refuses README.md '![picture](docs/images/gone.png)' docs/images/gone.png
refuses README.md '[step](docs/guide.md#step-2)' docs/guide.md#step-2
refuses README.md '[Step](docs/guide.md#Step)' docs/guide.md#Step
refuses README.md '[comment](docs/guide.md#only-a-comment)' docs/guide.md#only-a-comment
refuses README.md '[a heading of another file](#step)' '#step'
refuses README.md '[guide]: docs/gone.md' docs/gone.md
refuses CHANGELOG.md '- [gone](gone.md)' gone.md
refuses docs/guide.md '[from the top](docs/guide.md)' docs/guide.md
refuses docs/guide.md "$(printf 'A `code\nspan` and [a link](gone.md) and `another`.')" gone.md
refuses docs/decisions/0001.md '| table | [`x`](../core/x.hpp) |' ../core/x.hpp
accepts README.md '[title](#a-title), [next](docs/guide.md#guide-first-then-next_step) and [web](https://example.org/gone.md).'
accepts README.md 'A lambda `[](int a)` and an index `v[0](1)`.'
accepts docs/guide.md "$(printf '```cpp\nauto f = [](int a) { return v[a](a); };\n```')"
accepts docs/decisions/0001.md '| table | [`x`](../../core/x.hpp) |'

# A checkout whose links are no longer found is not one whose links are good.
for document in README.md docs/guide.md; do echo 'No link.' >"$tree/$document"; done
! sh "$links" "$tree" >"$folder/said" || { bad=$((bad + 1)) && echo "a tree without links is accepted"; }
[ "$bad" -eq 0 ]
