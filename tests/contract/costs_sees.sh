#!/bin/sh
# costs_sees.sh CHECKOUT: tests/target/costs.sh finds what it is for, on a target made of scripts: two scenes, a
# compiler that only knows its version, an emulator that prints what images of costs.cpp would.
set -eu
costs=$1/tests/target/costs.sh
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/Forces_20us.dir" "$folder/Torque_20us.dir"

script() { cat >"$folder/$1" && chmod +x "$folder/$1"; }
script g++ <<'END'
#!/bin/sh
echo 12.2.1
END
script size <<'END'
#!/bin/sh
printf '.text.step 1000 0\n.rodata.tables 2000 0\n'
END
script qemu-none <<'END'
#!/bin/sh
[ "$1" != --version ] || { echo 'QEMU emulator version 7' && exit; }
case $1 in *Forces*) step=300 ;; *) step=100 ;; esac
printf 'instructions idle %d %d\n' $step $((step + 1))
printf 'instructions rated %d %d\n' $step $((step + 1))
printf 'instructions redline %d %d\n' $step $((step + 1))
printf 'searched %d\nram 64\npainted_stack 32\n' $((step + 2))
END
for engine in Forces Torque; do
  printf '%s\n' 'node: { title: "step" label: "Engine::step(Input)\nfile\n40 bytes (static)" }' >"$folder/${engine}_20us.dir/step.ci"
done
cat >"$folder/costs.conf" <<END
title='No target' compiler='$folder/g++' size='$folder/size' emulator='"$folder/qemu-none"' build_type=-O3 images='$folder'
engines='Torque_20us Forces_20us' worst_tick= cycles_of= step_cycles= page='$folder/none.md'
END

bad=0
# sees STATUS TEXT: costs.sh check ends with that and says so.
sees() {
  if said=$(sh "$costs" "$folder/costs.conf" check 2>&1); then status=0; else status=$?; fi
  case $status:$said in "$1":*"$2"*) return ;; esac
  bad=$((bad + 1))
  printf 'expected status %s and "%s", but costs.sh ended with %s and said:\n%s\n' "$1" "$2" "$status" "$said"
}
sh "$costs" "$folder/costs.conf" write
committed=$(cat "$folder/none.md")

# committed_with SED STATUS TEXT: the committed table changed so.
committed_with() {
  printf '%s\n' "$committed" | sed "$1" >"$folder/none.md"
  sees "$2" "$3"
}
committed_with '' 0 '2 passed, 0 failed'
committed_with 's/^| Torque | 20 | 100 /| Torque | 20 | 97 /' 1 'Torque, 20 us: 97 -> 100'
committed_with 's/^| Torque | 20 | 100 /| Torque | 20 | 99 /' 0 '2 passed, 0 failed'
committed_with '/^| Forces/d' 1 'Forces, 20 us: not in the committed table'
committed_with 's/^\(| Forces | \)20\(.*\)/&\n\1100\2/' 1 'Forces, 100 us: committed, but measured no more'
committed_with '/^| Torque/s/ - / 105 /' 1 'Torque, 20 us: 105 -> none'
# Another compiler: figures are not compared, rows are.
committed_with 's/12\.2\.1/11.0/' 77 '2 rows not compared'
committed_with 's/12\.2\.1/11.0/; s/^| Torque | 20 | 100 /| Torque | 20 | 50 /' 77 'Torque, 20 us: 50 -> 100'
committed_with 's/version 7/version 6/' 77 '2 rows not compared'
committed_with 's/12\.2\.1/11.0/; s/^\(| Forces | \)20\(.*\)/&\n\1100\2/' 1 'Forces, 100 us: committed, but measured no more'
committed_with '1,$d' 1 'not in the committed table'

# Cycles: from a worst_tick and a plugin that say what they should, and what they should not.
cp "$folder/qemu-none" "$folder/qemu-plain"
sed 's/^printf/#printf/' "$folder/qemu-plain" >"$folder/qemu-none"
cat >>"$folder/qemu-none" <<'END'
for name in idle rated redline; do
  printf 'cycles %d %d %d %d 10 %d\n' $((step * 2)) $((step * 2 + 5)) $((step * 9)) $((step * 9 + 5)) $((step - 2))
  printf 'instructions %s %d %d\n' $name $step $((step + 1))
done
printf 'cycles %d %d %d %d 10 %d\n' $((step * 3)) $((step * 3 + 5)) $((step * 10)) $((step * 10 + 5)) $((step - 1))
printf 'searched %d\nram 64\npainted_stack 32\n' $((step + 2))
END
script objdump </dev/null
script addr2line </dev/null
# shellcheck disable=SC2016  # the script's own
bounds_of() { printf '#!/bin/sh\ncase $1 in *Forces*) echo %s ;; *) echo %s ;; esac\n' "$1" "$2" | script worst_tick; }
bounds_of '400 999 4000' '200 305 1010'
sed -i "s|worst_tick= cycles_of= step_cycles=|worst_tick='$folder/worst_tick' cycles_of=cortex-m4 step_cycles=none.so|" "$folder/costs.conf"
plain=$committed
committed=
sh "$costs" "$folder/costs.conf" write
committed=$(cat "$folder/none.md")
committed_with '' 0 '6 passed, 0 failed'
committed_with 's,^| Torque | 20 | 200 /,| Torque | 20 | 190 /,' 1 'Torque, 20 us, cycles at 0 wait states: 190 -> 200'
committed_with 's,^| Torque | 20 | 900 /,| Torque | 20 | 850 /,' 1 'Torque, 20 us, cycles at 5 wait states: 850 -> 900'
committed_with '/^Cycles, 5/,/^<!-- end/{/^| Forces/d}' 1 'Forces, 20 us, cycles at 5 wait states: not in the committed table'
bounds_of '400 999 4000' '200 304 1010'
sees 1 'Torque: took more cycles than its bound of 304'
bounds_of '400 999 4000' '200 305 1004'
sees 1 'Torque: took more cycles than its bound of 1004'
bounds_of '1100 999 4000' '200 305 1010'
sees 1 'Forces: 999 cycles are fewer than the instructions'
bounds_of '400 999 4000' '200 305 1010'
# shellcheck disable=SC2016
sed -i 's/\$((step - 2))$/$((step - 9))/' "$folder/qemu-none"
sees 1 'Torque, idle: the counts of instructions differ by 10'
sed -i "s|cycles_of=cortex-m4|cycles_of=|; s|worst_tick='[^']*'|worst_tick=|" "$folder/costs.conf"
cp "$folder/qemu-plain" "$folder/qemu-none"
committed=$plain

# An emulator that runs nothing.
printf '%s\n' "$committed" >"$folder/none.md"
sed -i '3,$d' "$folder/qemu-none"
sees 1 ''
[ "$bad" -eq 0 ]
