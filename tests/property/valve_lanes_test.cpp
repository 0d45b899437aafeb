// Valves abreast and one by one: the same bits, whatever number of them, at ticks of one fine step and of many.
#include "property/valve_lanes_run.hpp"

namespace crankloop::valve_lanes::valve_lanes_test {
namespace {

struct AsTheTargetHasThem {};

TEST(ValveLanes, HaveTheBitsOfValvesOneByOne) {
  for (const double tick_s : {20e-6, 100e-6, 1e-3}) {
    const std::vector<LanesRun> abreast = all_runs<AsTheTargetHasThem>(tick_s);
    const std::vector<LanesRun> one_by_one = runs_one_by_one(tick_s);
    ASSERT_EQ(abreast.size(), one_by_one.size());
    for (std::size_t i = 0; i < abreast.size(); ++i) {
      ASSERT_EQ(abreast[i].bits.size(), one_by_one[i].bits.size());
      std::size_t at = 0;
      while (at < abreast[i].bits.size() && abreast[i].bits[at] == one_by_one[i].bits[at]) ++at;
      EXPECT_EQ(at, abreast[i].bits.size())
          << abreast[i].name << ", " << tick_s * 1e6 << " us: word " << at << " of " << abreast[i].bits.size();
    }
  }
}

}  // namespace
}  // namespace crankloop::valve_lanes::valve_lanes_test
