# shellcheck shell=sh
# Counting a program's instructions: sourced by figures/figures.sh and bench/bench.sh.

# instructions COMMAND...: from start to end, by valgrind's callgrind. Two runs of different length tell what one step
# takes.
instructions() { valgrind --tool=callgrind --callgrind-out-file=/dev/null "$@" 2>&1 | awk '/Collected :/ { print $4 }'; }
