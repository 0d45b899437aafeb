#!/bin/sh
# contraction_is_refused.sh COMPILER CORE_DIR
# A scene whose translation unit fuses a*b + c is refused by init, at every optimisation that fuses; one that does not
# is not, also when both are linked into one program: each answers for itself. Exit status 77, "skipped", where this
# machine's processor has no fused multiply-add.
set -eu
compiler=$1 core=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

echo | "$compiler" -march=native -dM -E -x c++ - 2>/dev/null | grep -qE '__FMA__|__ARM_FEATURE_FMA' || exit 77

# A scene's unit: says why init refuses an engine without tables.
cat >unit.cpp <<'END'
#include <crankloop/tick/step.hpp>
namespace {
struct MyScene : crankloop::Scene {};
template <class Real>
crankloop::Reason answer() {
  static const crankloop::Tables<Real, MyScene> none;
  crankloop::Engine<Real, MyScene> engine;
  return engine.init(none).reason;
}
}
crankloop::Reason NAME_float() { return answer<float>(); }
crankloop::Reason NAME_double() { return answer<double>(); }
END
cat >main.cpp <<'END'
#include <crankloop/status.hpp>
using crankloop::Reason;
Reason fused_float(), fused_double(), plain_float(), plain_double();
int main() {
  const bool right = fused_float() == Reason::contracting_build && fused_double() == Reason::contracting_build &&
                     plain_float() == Reason::missing_table && plain_double() == Reason::missing_table;
  return right ? 0 : 1;
}
END

compile() { "$compiler" -std=c++17 -march=native -I "$core/include" "$@"; }
for level in -O2 -O3 -Os; do  # below, GCC does not fuse
  compile $level -ffp-contract=fast -DNAME_float=fused_float -DNAME_double=fused_double -c unit.cpp -o fused.o
  compile $level -ffp-contract=off -DNAME_float=plain_float -DNAME_double=plain_double -c unit.cpp -o plain.o
  compile $level -c main.cpp -o main.o
  for objects in 'fused.o plain.o' 'plain.o fused.o'; do
    # shellcheck disable=SC2086  # two words
    compile main.o $objects -o program
    ./program || { echo "at $level, linked as $objects: a unit that fuses is accepted, or one that does not is refused" && exit 1; }
  done
done
