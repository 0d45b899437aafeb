# shellcheck shell=sh
# Counting a program's instructions: sourced by the scripts that do.

# instructions COMMAND...: from start to end, by valgrind's cachegrind without caches, which takes half as long as
# callgrind. Two runs of different length tell what one step takes. Where the command fails, so does this, with what it
# said.
instructions() {
  said=$(valgrind --tool=cachegrind --cache-sim=no --cachegrind-out-file=/dev/null "$@" 2>&1) || { echo "$said" >&2 && return 1; }
  echo "$said" | awk '/I +refs:/ { gsub(",", ""); print $NF }'
}

# instructions_within FUNCTION COMMAND...: those of a function and of what it calls, by callgrind.
instructions_within() {
  function=$1
  shift
  valgrind --tool=callgrind --callgrind-out-file=/dev/null "--toggle-collect=$function" "$@" 2>&1 |
    awk '/Collected :/ { print $4 }'
}
