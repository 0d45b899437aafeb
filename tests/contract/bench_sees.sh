#!/bin/sh
# bench_sees.sh CHECKOUT: tests/contract/bench/bench.sh finds what it is for, and tells what it leaves out: with a
# program of two kernels, a compiler and a valgrind made of scripts.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir -p "$folder/contract/bench" "$folder/build/bin" "$folder/path" "$folder/tools"
cp "$1/tests/contract/instructions.sh" "$folder/contract"
cp "$1/tests/contract/bench/bench.sh" "$folder/contract/bench"

script() { cat >"$folder/$1" && chmod +x "$folder/$1"; }
script path/cmake <<'END'
#!/bin/sh
END
script g++ <<'END'
#!/bin/sh
echo 'g++ (none) 12.2.0'
END
echo "CMAKE_CXX_COMPILER:FILEPATH=$folder/g++" >"$folder/build/CMakeCache.txt"
script build/bin/crankloop <<'END'
#!/bin/sh
case "$*" in
  *list) echo 'kernels: motion, valve' ;;
  *--errors*) printf 'group,contestant,real,setting,a,b,c,error,unit\nmotion,linear,float,1 deg,0,0,0,100,of r\nvalve,rk4,float,1 us,0,0,0,100,um\n' ;;
esac
END
# 50 instructions a tick, and some to begin with.
script path/valgrind <<'END'
#!/bin/sh
for ticks in "$@"; do :; done
echo "==1== I   refs:      $((1000 + 50 * ticks))" >&2
END
for command in sh awk cat cp cut dirname grep head mkdir nproc sed tail tr uname; do ln -s "$(command -v $command)" "$folder/path/$command"; done
bench() { PATH=$folder/path sh "$folder/contract/bench/bench.sh" "$folder/build" "$1"; }
bench renew

bad=0
# sees STATUS TEXT: bench.sh check ends with that and says so.
sees() {
  if said=$(bench check 2>&1); then status=0; else status=$?; fi
  case $status:$said in "$1":*"$2"*) return ;; esac
  bad=$((bad + 1))
  printf 'expected status %s and "%s", but bench.sh ended with %s and said:\n%s\n' "$1" "$2" "$status" "$said"
}
# committed_with FILE SED STATUS TEXT: the committed file changed so.
committed_with() {
  cp "$folder/contract/bench/$1" "$folder/kept"
  sed "$2" "$folder/kept" >"$folder/contract/bench/$1"
  sees "$3" "$4"
  cp "$folder/kept" "$folder/contract/bench/$1"
}
sees 0 '2 passed, 0 failed'
committed_with instructions.txt 's/^valve 50/valve 48/' 1 'valve takes 50 instructions a tick, 48 were committed
1 passed, 1 failed'
committed_with instructions.txt 's/^valve 50/&\ncrank 50/' 1 'crank is gone'
committed_with instructions.txt '/^valve/d' 1 'valve is not in instructions.txt'
committed_with errors.csv 's/,100,um/,97,um/' 1 'valve,rk4,float,1 us errs by 100, 97 was committed
1 passed, 1 failed'
committed_with errors.csv 's/^valve/&,new/' 1 'is gone'
# Another compiler: not compared, and it says so.
committed_with instructions.txt '1s/12\.2/11.0/' 0 'skipped bench.instructions: (none) 12.2.0'
committed_with instructions.txt '1s/12\.2/11.0/' 0 '
1 passed, 0 failed'
rm "$folder/path/valgrind"
sees 1 'no valgrind to count instructions with
1 passed, 1 failed'
[ "$bad" -eq 0 ]
