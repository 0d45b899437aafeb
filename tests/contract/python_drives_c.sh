#!/bin/sh
# python_drives_c.sh LIBRARY PROGRAM: Python's ctypes can drive the shared C interface. Exit status 77, "skipped", where there is no Python.
set -eu
command -v python3 >/dev/null || exit 77
said=$(python3 "$2" "$1")
echo "$said"
case $said in *' Nm after a cycle, faults 0') ;; *) exit 1 ;; esac
