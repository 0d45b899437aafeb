// Runs the golden tests. With `--renew WHY`, which tests/golden/renew.sh gives and no run of tests does, they write
// what they would compare.
#include <cstdio>
#include <cstring>

#include <gtest/gtest.h>

#include "support/golden.hpp"

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);  // takes its own arguments away
  if (argc == 3 && std::strcmp(argv[1], "--renew") == 0 && *argv[2] != '\0') {
    crankloop::support::renewal() = argv[2];
  } else if (argc != 1) {
    std::fprintf(stderr, "usage: %s [--renew WHY]\n", argv[0]);
    return 2;
  }
  return RUN_ALL_TESTS();
}
