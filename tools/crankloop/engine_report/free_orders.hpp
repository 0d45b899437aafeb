// The orders of free forces that are shown: all significant ones.
#pragma once

#include <vector>

#include <crankloop/define/crank.hpp>

namespace crankloop::program {

struct FreeOrder {
  int order;
  const char* name;
};

/// Without a pin offset there are no odd orders above the first.
inline std::vector<FreeOrder> free_orders(const Crank& crank) {
  if (crank.pin_offset_m == 0) return {{1, "first"}, {2, "second"}, {4, "fourth"}, {6, "sixth"}};
  return {{1, "first"}, {2, "second"}, {3, "third"}, {4, "fourth"}, {5, "fifth"}, {6, "sixth"}};
}

}  // namespace crankloop::program
