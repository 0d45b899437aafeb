#!/bin/sh
# What the documents show of the program's output is what it prints.
#
#   printed.sh PROGRAM check DOCUMENT...   runs each command that a document shows, and compares
#   printed.sh PROGRAM renew DOCUMENT...   writes into the documents what it prints now
#
# A command is a line "$ crankloop ..." in a fenced block; the lines below it, to the next command or the block's end, are
# of its output. It runs in a folder with the sample engines. The lines stand in the order in which they are printed, with
# others left out between them; of a line the remark may be left out, of a table's row the last columns. A line that the
# program itself marks as its machine's ("# this machine") has no value to compare. In a block without a language no
# "name = value" stands without its command.
set -eu
program=$(realpath "$1")
mode=$2
shift 2
case $mode in check | renew) ;; *) sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$0" >&2 && exit 2 ;; esac
engines=$(CDPATH='' cd -- "$(dirname -- "$0")/../../../tools/engines" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/bin" "$work/engines"
ln -s "$program" "$work/bin/crankloop"
cp "$engines"/* "$work/engines"

bad=0
for document in "$@"; do
  awk -v document="$document" -v mode="$mode" -v work="$work" '
    function complain(text) { print document ":" FNR ": " text >"/dev/stderr"; bad = 1 }

    # Reads what a command prints to printed[1..count].
    function run(command,    out, line) {
      out = work "/out"
      if (system("cd " work "/engines && PATH=" work "/bin:$PATH && " command " >" out " 2>" work "/err") != 0)
        complain("this fails: " command)
      for (count = 0; (getline line <out) > 0;) printed[++count] = line
      close(out)
      place = 1
    }
    function is_assignment(line) { return line ~ /^[A-Za-z][A-Za-z0-9_.]* = / }
    # Without its remark.
    function bare(line) { sub(/  #.*/, "", line); return line }
    # By what a line is known when its value has changed.
    function key(line,    words) {
      split(line, words)
      return words[1] == "#" ? words[1] " " words[2] " " words[3] : words[1]
    }
    # As many words of a line as `of` has.
    function first_words(line, of,    words, shown, n, i, text) {
      n = split(of, shown)
      split(line, words)
      for (i = 1; i <= n; ++i) text = text (i > 1 ? " " : "") words[i]
      return text
    }
    function is_machines(line) { return line ~ /# this machine/ }
    # What the document shows of a printed line, as much of it as it shows now.
    function shown_of(line, now) {
      if (is_machines(line)) return now
      if (!is_assignment(line)) return line ~ /^#/ ? line : first_words(line, now)
      return now ~ /  #/ ? line : bare(line)
    }
    function expect(now, indent,    i, words) {
      if (!is_assignment(now) && now !~ /^#/) now = first_words(now, now)
      for (i = place; i <= count; ++i) {
        if (key(printed[i]) != key(now)) continue
        if (shown_of(printed[i], now) == now || mode == "renew") {
          place = i + 1
          return indent (shown_of(printed[i], now) == now ? substr($0, length(indent) + 1) : shown_of(printed[i], now))
        }
        if (is_assignment(now)) break
      }
      complain("shows \"" now "\"; " (i <= count ? "printed is \"" shown_of(printed[i], now) "\"" : "that is not printed there") " by: " command)
      return $0
    }

    { line = $0; indent = ""; if (match($0, /^ +/)) { indent = substr($0, 1, RLENGTH); line = substr($0, RLENGTH + 1) } }
    line ~ /^```/ { inside = !inside; language = substr(line, 4); command = ""; print; next }
    inside && line ~ /^\$ crankloop / { command = substr(line, 3); run(command); commands++; print; next }
    inside && command != "" && line != "" { print expect(line, indent); next }
    inside && language == "" && is_assignment(line) { complain("shows an output without its command: " line) }
    { print }
    END { if (commands > 0) print document ": " commands " commands" >"/dev/stderr"; exit bad }
  ' "$document" >"$work/document" || bad=1
  [ "$mode" = check ] || cmp -s "$work/document" "$document" || cat "$work/document" >"$document"
done
exit $bad
