// The C library's elementary functions against crankloop's own (docs/decisions/0006-elementary.md): a hash of a million
// results of each function. figures.sh runs this twice, the second time with the C library told that the processor has
// no fused multiply-add.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>

#include <crankloop/tabulate/elementary.hpp>

#include "support/random.hpp"

namespace {

namespace own = crankloop::elementary;
using crankloop::support::Random;

constexpr int kCalls = 1000000;

struct Hash {
  std::uint64_t sum = 0xcbf29ce484222325u;
  void add(double x) {
    std::uint64_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    sum = (sum ^ bits) * 0x100000001b3u;
  }
};

template <class Own, class Libm>
void compare(const char* name, double low, double high, const Own& of_own, const Libm& of_libm) {
  Random random(495);
  Hash own_hash;
  Hash libm_hash;
  int differ = 0;
  for (int i = 0; i < kCalls; ++i) {
    const double x = random.between(low, high);
    const double a = of_own(x);
    const double b = of_libm(x);
    own_hash.add(a);
    libm_hash.add(b);
    differ += a == b ? 0 : 1;
  }
  std::printf("%-5s own %016llx  C library %016llx  differ in %d of %d\n", name,
              static_cast<unsigned long long>(own_hash.sum), static_cast<unsigned long long>(libm_hash.sum), differ,
              kCalls);
}

}  // namespace

int main() {
  compare("sin", -12.6, 12.6, own::sin, [](double x) { return std::sin(x); });
  compare("cos", -12.6, 12.6, own::cos, [](double x) { return std::cos(x); });
  compare("asin", -1, 1, own::asin, [](double x) { return std::asin(x); });
  compare("atan", -10, 10, own::atan, [](double x) { return std::atan(x); });
  compare("exp", -10, 10, own::exp, [](double x) { return std::exp(x); });
  compare("log", 1e-3, 1e3, own::log, [](double x) { return std::log(x); });
  compare(
      "pow", 1e-3, 1e3, [](double x) { return own::pow(x, 1.35); }, [](double x) { return std::pow(x, 1.35); });
  return 0;
}
