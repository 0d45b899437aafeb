#!/bin/sh
# run.sh QEMU ARGUMENT... IMAGE: the machine "none" has no -kernel, and its loader wants the image inside an argument.
set -eu
image=
arguments=0
for argument in "$@"; do
  image=$argument
  arguments=$((arguments + 1))
done
while [ "$arguments" -gt 1 ]; do  # all but the last go to the end
  set -- "$@" "$1"
  shift
  arguments=$((arguments - 1))
done
shift
exec "$@" -device "loader,file=$image,cpu-num=0"
