#!/bin/sh
# python_drives_c.sh LIBRARY_FOLDER PROGRAM ENGINE_FILE EXPECTED: Python's ctypes can drive the shared C interface, from
# the engine file to 10^5 ticks in one call, and its first line is that of the file EXPECTED, of a program in C that
# steps tick by tick. Exit status 77, "skipped", where there is no Python.
set -eu
command -v python3 >/dev/null || exit 77
said=$(python3 "$2" "$1" "$3")
echo "$said"
expected=$(cat "$4")
case $said in "$expected"*) ;; *) echo "expected $expected" && exit 1 ;; esac
case $said in *'largest lift 1'[01].*' mm') ;; *) exit 1 ;; esac # 7.2 mm at the tappet, rocker ratio 1.5
said=$(python3 "$2" "$1" /nowhere.ini 2>&1) && exit 1
case $said in /nowhere.ini*) ;; *) echo "said of a file that is not there: $said" && exit 1 ;; esac
