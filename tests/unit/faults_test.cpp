// Fault bits in words, as a firmware's log has them.
#include <crankloop/faults.hpp>

#include <gtest/gtest.h>

#include <string>

namespace crankloop::faults_test {
namespace {

TEST(FaultsInWords, NameEachBitThatIsSet) {
  EXPECT_STREQ(describe(std::uint32_t{0}).text, "none");
  EXPECT_STREQ(describe(kFaultNotReady).text, "not ready");
  EXPECT_STREQ(describe(kFaultSpeed | kFaultCamPhase).text, "speed, cam phase");
  EXPECT_STREQ(describe(kFaultTriggerEdges | 1u << 31).text, "trigger edges, unknown");
  EXPECT_STREQ(describe(kFaultGas | kFaultManifold | kFaultBurn).text, "gas, manifold, burn");
  static_assert(describe(kFaultExternalTorque).text[0] == 'e');  // also where there is no library at run time
}

/// Each fault has a name of its own; all of them together still end within the text.
TEST(FaultsInWords, HaveRoomForAllOfThem) {
  const std::string all = describe(~std::uint32_t{0}).text;
  EXPECT_LT(all.size(), sizeof(FaultText::text));
  EXPECT_EQ(all.substr(all.size() - 9), ", unknown");
  int known = 0;
  for (std::uint32_t bit = 1; bit != 0; bit <<= 1) {
    const std::string name = describe(bit).text;
    if (name == "unknown") continue;
    ++known;
    EXPECT_EQ(all.find(name == "speed" ? ", speed" : name), all.rfind(name == "speed" ? ", speed" : name)) << name;
    EXPECT_NE(all.find(name), std::string::npos);
  }
  EXPECT_EQ(known, 13);
}

}  // namespace
}  // namespace crankloop::faults_test
