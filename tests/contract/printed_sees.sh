#!/bin/sh
# printed_sees.sh CHECKOUT: tests/contract/figures/printed.sh finds what it is for, in documents of a program that is a
# script, and renews them.
set -eu
printed=$1/tests/contract/figures/printed.sh
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
bad=0

cat >"$folder/program" <<'END'
#!/bin/sh
[ "$*" != "fails" ] || exit 1
[ -f diesel_495.ini ] || exit 1
cat <<'OUT'
# an engine
speed = 2000 rpm
delay = none  # in the air
power = 44 kW  # indicated

rpm  lift  gap
 10   7.5    0
 20   7.6  0.1
time = 17 ns  # this machine: a median
OUT
END
chmod +x "$folder/program"

# document LINE...: a document that shows a command and these lines of it.
document() { { printf 'Text.\n\n  ```\n' && printf '  $ crankloop run x\n' && printf '  %s\n' "$@" && printf '  ```\n'; } >"$folder/document.md"; }
check() { "$printed" "$folder/program" check "$folder/document.md" >"$folder/said" 2>&1; }
holds() {
  document "$@"
  check || { echo "should hold: $*" && cat "$folder/said" && bad=1; }
}
refuses() {
  document "$@"
  ! check || { echo "should be refused: $*" && bad=1; }
}

holds '# an engine' 'speed = 2000 rpm' 'power = 44 kW' 'rpm lift' '20 7.6 0.1'
holds 'power = 44 kW  # indicated' 'time = 99 ns  # this machine: a median'
refuses 'speed = 1999 rpm'
refuses 'speed = 2000'
refuses 'power = 44 kW  # brake'
refuses 'power = 44 kW' 'speed = 2000 rpm'
refuses '20 7.5'
refuses 'torque = 3 Nm'
printf '```\nspeed = 2000 rpm\n```\n' >"$folder/document.md"
! check || { echo 'an output without its command should be refused' && bad=1; }
printf '```\n$ crankloop fails\n```\n' >"$folder/document.md"
! check || { echo 'a command that fails should be refused' && bad=1; }

document '# an engine' 'speed = 1 rpm' 'delay = 3 deg' 'power = 3 W  # of something' '10 1 2' 'time = 99 ns  # this machine: a median'
"$printed" "$folder/program" renew "$folder/document.md" 2>"$folder/said" || { cat "$folder/said" && bad=1; }
cp "$folder/document.md" "$folder/renewed.md"
document '# an engine' 'speed = 2000 rpm' 'delay = none' 'power = 44 kW  # indicated' '10 7.5 0' 'time = 99 ns  # this machine: a median'
diff "$folder/document.md" "$folder/renewed.md" || bad=1
check || bad=1
exit $bad
