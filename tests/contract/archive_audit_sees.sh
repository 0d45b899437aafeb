#!/bin/sh
# archive_audit_sees.sh COMPILER: the audit finds what it is for. Each case is a library with one thing in it that must
# not be there.
set -eu
compiler=$1
audit=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)/archive_audit.sh
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

bad=0
# sees COMPLAINT FLAGS SOURCE: the audit of the source's library says so; with COMPLAINT "" it says nothing.
sees() {
  rm -f "$folder"/*
  printf '%s\n' "$3" >"$folder/it.cpp"
  # shellcheck disable=SC2086  # flags are words
  "$compiler" -std=c++17 -O2 $2 -c "$folder/it.cpp" -o "$folder/it.o"
  ar rc "$folder/libit.a" "$folder/it.o"
  if said=$(sh "$audit" --float "$folder/libit.a" 2>&1); then accepted=yes; else accepted=no; fi
  case $accepted:$said in
    yes:) [ -z "$1" ] && return ;;
    no:*"$1"*) [ -n "$1" ] && return ;;
  esac
  bad=$((bad + 1))
  printf 'expected "%s" of: %s\nbut it said: %s\n' "$1" "$3" "$said"
}

house='-fno-exceptions -fno-rtti -fno-threadsafe-statics -ffp-contract=off'
sees '' "$house" 'namespace crankloop { float f(float a, float b, float c) { return a * b + c; } }'
# clang keeps a lambda that it does not inline; its name is local to a function of ours
sees '' "$house" 'namespace crankloop { template <class F> [[gnu::noinline]] int twice(F f) { return f() + f(); } inline int h(int a) { return twice([a]() __attribute__((noinline)) { return a; }); } int g(int a) { return h(a); } }'
sees '' "$house" '#include <cstring>
namespace it { struct S { char c[999]; }; void f(S& a, const S& b) { std::memcpy(&a, &b, sizeof a); } }'
sees 'asks the image for' "$house" '#include <cstdlib>
namespace crankloop { void* f() { return std::malloc(8); } }'
sees 'asks the image for' "$house" 'namespace crankloop { int* f() { return new int; } }'
sees 'asks the image for' "$house" '#include <cmath>
namespace crankloop { float f(float x) { return std::sin(x); } }'
sees 'sections' "$house" 'namespace crankloop { int counter = 1; int f() { return ++counter; } }'
sees 'sections' "$house" 'namespace crankloop { static int counter; int f() { return ++counter; } }'
sees 'sections' "$house" 'namespace crankloop { extern int g(); int h() { volatile int x = 3; return x; } const int k = h(); const int* f() { return &k; } }'
sees 'sections' '' 'namespace crankloop { struct A { ~A(); }; void g(); void f() { A a; g(); } }'
sees 'guards' "$house" 'namespace crankloop { int h(); int f() { static const int k = h(); return k; } }'
sees 'RTTI' '-fno-exceptions' 'namespace crankloop { struct A { virtual void g(); }; void A::g() {} }'
sees 'outside its own' "$house" 'int helper(int a) { return a + 1; }'
sees 'outside its own' "$house" 'namespace crank { int helper(int a) { return a + 1; } }'
if [ "$(uname -m)" = x86_64 ]; then
  sees 'fuses' '-mfma -ffp-contract=fast' 'namespace crankloop { float f(float a, float b, float c) { return a * b + c; } }'
  sees 'in double' "$house" 'namespace crankloop { float f(float a) { return static_cast<float>(a * 1.1); } }'
  sees 'in double' "$house" 'namespace crankloop { float f(float a) { return a > 1.1 ? a : 0; } }'
  sees 'in double' "$house -mavx2 -O3" 'namespace crankloop { void f(double* a) { for (int i = 0; i < 8; ++i) a[i] *= a[i]; } }'
  sees 'in double' "$house" 'namespace crankloop { long double f(long double a) { return a * a; } }'
fi
[ "$bad" -eq 0 ]
