// Layouts: firing orders, throws, banks, and which rods share a pin.
#include <crankloop/define/engine_definition.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "support/engines.hpp"
#include "support/status.hpp"

namespace crankloop::layout_test {
namespace {

using support::Bad;
using support::inline_four;
using support::Random;
using support::refuses;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kEps = std::numeric_limits<double>::epsilon();

TEST(FiringOrder, OfAnInlineFourSpreadsTheFiringsEvenlyOverTheCycle) {
  const Layout layout = inline_four();
  EXPECT_EQ(layout.cylinders, 4);
  const double want[] = {0, 540, 180, 360};  // 1-3-4-2
  for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(layout.firing_deg[k], want[k]) << "cylinder " << k + 1;
  EXPECT_TRUE(accepted(validate(layout)));
}

TEST(FiringOrder, MayBeginWithAnyCylinderAndAngleZeroIsStillTheFirst) {
  const int orders[][4] = {{1, 3, 4, 2}, {3, 4, 2, 1}, {4, 2, 1, 3}, {2, 1, 3, 4}};
  for (const auto& order : orders) {
    Layout layout;
    ASSERT_TRUE(accepted(set_firing_order(order, 4, layout)));
    for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(layout.firing_deg[k], inline_four().firing_deg[k]);
  }
}

TEST(FiringOrder, OfAnyEngineLeavesEqualIntervalsBetweenNeighboursInTheOrder) {
  Random random;
  for (int cylinders = 1; cylinders <= kMaxCylinders; ++cylinders) {
    std::vector<int> order;
    for (int k = 1; k <= cylinders; ++k) order.push_back(k);
    for (std::size_t i = order.size() - 1; i > 0; --i) {
      std::swap(order[i], order[static_cast<std::size_t>(random.whole(0, static_cast<int>(i)))]);
    }
    Layout layout;
    ASSERT_TRUE(accepted(set_firing_order(order.data(), cylinders, layout)));
    EXPECT_EQ(layout.firing_deg[0], 0);
    for (std::size_t i = 0; i < order.size(); ++i) {
      const double here = layout.firing_deg[static_cast<std::size_t>(order[i] - 1)];
      const double next = layout.firing_deg[static_cast<std::size_t>(order[(i + 1) % order.size()] - 1)];
      EXPECT_NEAR(std::fmod(next - here + 1440, 720), cylinders == 1 ? 0 : 720.0 / cylinders, 1440 * kEps)
          << random.trace(cylinders);
    }
    EXPECT_TRUE(accepted(validate(layout)));
  }
}

TEST(FiringOrder, ThatIsNoPermutationIsRefusedAtTheEntryThatBreaksIt) {
  Layout layout = inline_four();
  const int twice[] = {1, 3, 3, 2};
  EXPECT_TRUE(refuses(set_firing_order(twice, 4, layout), Reason::not_a_permutation, "order", 2));
  const int beyond[] = {1, 3, 4, 5};
  EXPECT_TRUE(refuses(set_firing_order(beyond, 4, layout), Reason::not_a_permutation, "order", 3));
  const int zero[] = {0, 3, 4, 2};
  EXPECT_TRUE(refuses(set_firing_order(zero, 4, layout), Reason::not_a_permutation, "order", 0));
  const int negative[] = {1, -2147483647 - 1, 4, 2};
  EXPECT_TRUE(refuses(set_firing_order(negative, 4, layout), Reason::not_a_permutation, "order", 1));
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_EQ(layout.firing_deg[k], inline_four().firing_deg[k]) << "a refusal changes nothing";
}

TEST(FiringOrder, IsForOneToSixteenCylinders) {
  int order[20] = {};
  for (int i = 0; i < 20; ++i) order[i] = i + 1;
  Layout layout;
  EXPECT_TRUE(refuses(set_firing_order(order, 0, layout), Reason::out_of_range, "layout.cylinders"));
  EXPECT_TRUE(refuses(set_firing_order(order, -1, layout), Reason::out_of_range, "layout.cylinders"));
  EXPECT_TRUE(refuses(set_firing_order(order, 17, layout), Reason::out_of_range, "layout.cylinders"));
  EXPECT_TRUE(accepted(set_firing_order(order, 16, layout)));
}

TEST(LayoutDefinition, RefusesACountThatIsNoEngine) {
  for (const int bad : {0, -1, 17, 1'000'000}) {
    Layout layout = inline_four();
    layout.cylinders = bad;
    EXPECT_TRUE(refuses(validate(layout), Reason::out_of_range, "layout.cylinders")) << bad;
  }
}

TEST(LayoutDefinition, RefusesAnAngleOrPlaceThatIsNoneAndNamesTheCylinder) {
  const struct {
    std::array<double, kMaxCylinders> Layout::*member;
    const char* field;
    double too_low, too_high;
    Reason if_low;
  } fields[] = {{&Layout::firing_deg, "layout.firing_deg", -1e-9, 720, Reason::negative},
                {&Layout::bank_deg, "layout.bank_deg", -360.5, 360.5, Reason::out_of_range},
                {&Layout::position_m, "layout.position_m", -100.5, 100.5, Reason::out_of_range}};
  for (const auto& field : fields) {
    for (const Bad& bad :
         {Bad{kNaN, Reason::not_finite}, Bad{kInfinity, Reason::not_finite}, Bad{-kInfinity, Reason::not_finite},
          Bad{field.too_low, field.if_low}, Bad{field.too_high, Reason::out_of_range}}) {
      Layout layout = inline_four();
      (layout.*field.member)[2] = bad.value;
      EXPECT_TRUE(refuses(validate(layout), bad.reason, field.field, 2)) << bad.value;
    }
  }
}

TEST(LayoutDefinition, ReadsNothingBeyondItsCylinders) {
  Layout layout = inline_four();
  layout.firing_deg[4] = kNaN;
  layout.position_m[15] = kInfinity;
  layout.pin[7] = 200;
  EXPECT_TRUE(accepted(validate(layout)));
}

TEST(LayoutDefinition, RefusesCylindersThatShareAPinTheirThrowsDoNotAllow) {
  Layout layout = inline_four();
  layout.pin = {0, 1, 1, 2};  // 2 and 3 fire 360 deg apart: their throws point the same way
  EXPECT_TRUE(accepted(validate(layout)));
  layout.pin = {0, 0, 1, 2};  // 1 and 2 are half a turn apart
  EXPECT_TRUE(refuses(validate(layout), Reason::inconsistent, "layout.pin", 1));
}

TEST(LayoutDefinition, RefusesPinNumbersWithAGapOrBeyondTheCylinders) {
  Layout layout = inline_four();
  layout.pin = {0, 2, 2, 3};
  EXPECT_TRUE(refuses(validate(layout), Reason::inconsistent, "layout.pin"));
  layout.pin = {1, 2, 2, 3};
  EXPECT_TRUE(refuses(validate(layout), Reason::inconsistent, "layout.pin"));
  layout.pin = {0, 1, 4, 2};
  EXPECT_TRUE(refuses(validate(layout), Reason::out_of_range, "layout.pin", 2));
}

TEST(LayoutDefinition, TakesForAPinsPlaceTheMiddleOfItsRods) {
  Layout layout;
  layout.cylinders = 3;
  layout.pin = {0, 1, 1};
  layout.position_m = {0.02, 0, 0.06};
  EXPECT_TRUE(accepted(validate(layout))) << "0.02 and 0.03";
  layout.position_m = {0.02, 0.06, 0};
  EXPECT_TRUE(accepted(validate(layout))) << "in whichever order they are listed";
  layout.position_m = {0.02, 0, 0.04};
  EXPECT_TRUE(accepted(validate(layout))) << "at one place";
  for (const double other_m : {0.039, -0.06}) {
    layout.position_m = {0.02, 0, other_m};
    EXPECT_TRUE(refuses(validate(layout), Reason::inconsistent, "layout.pin")) << other_m;
  }
}

TEST(LayoutDefinition, RefusesPinsThatAreNotNumberedAlongTheShaft) {
  Layout layout = inline_four();
  layout.pin = {0, 1, 3, 2};
  EXPECT_TRUE(refuses(validate(layout), Reason::inconsistent, "layout.pin"));
  layout.position_m = {0, 0.1, 0.3, 0.2};
  EXPECT_TRUE(accepted(validate(layout)));
}

TEST(LayoutDefinition, ThrowPointsWhereBankAndFiringAngleSay) {
  Layout layout;
  layout.cylinders = 2;
  layout.bank_deg = {-45, 45};
  layout.firing_deg = {0, 90};
  EXPECT_EQ(layout.throw_deg(0), -45);
  EXPECT_EQ(layout.throw_deg(1), -45);
}

TEST(SharedPins, ByPositionJoinTheRodsOfAVEngineAndLeaveAnInlineEngineAlone) {
  Layout four = inline_four();
  share_pins_by_position(four);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(four.pin[k], k);

  // A cross-plane V8, left bank 1 to 4, right bank 5 to 8: cylinders 1 and 5, 2 and 6 ... on one pin. Throws at -45,
  // 45, 225, 135 deg.
  Layout v8;
  v8.cylinders = 8;
  v8.bank_deg = {-45, -45, -45, -45, 45, 45, 45, 45};
  v8.position_m = {0, 0.1, 0.2, 0.3, 0, 0.1, 0.2, 0.3};
  const double throws[] = {-45, 45, 225, 135};
  for (std::size_t k = 0; k < 8; ++k) v8.firing_deg[k] = std::fmod(v8.bank_deg[k] - throws[k % 4] + 720, 720);
  share_pins_by_position(v8);
  for (std::size_t k = 0; k < 8; ++k) EXPECT_EQ(v8.pin[k], k % 4) << "cylinder " << k + 1;
  EXPECT_TRUE(accepted(validate(v8)));
}

TEST(SharedPins, ByPositionAreNumberedAlongTheShaftWhateverTheOrderOfTheCylinders) {
  Layout layout;
  layout.cylinders = 3;
  layout.position_m = {0.2, 0.0, 0.1};
  layout.firing_deg = {0, 240, 480};
  share_pins_by_position(layout);
  EXPECT_EQ(layout.pin[0], 2);
  EXPECT_EQ(layout.pin[1], 0);
  EXPECT_EQ(layout.pin[2], 1);
}

TEST(SharedPins, ByPositionStaySplitWhereTheThrowsDiffer) {
  // A boxer twin: both rods at nearly one place but throws half a turn apart. And a 90 deg V6 of even firing: split
  // pins 30 deg apart.
  Layout boxer;
  boxer.cylinders = 2;
  boxer.bank_deg = {-90, 90};
  boxer.firing_deg = {0, 360};
  share_pins_by_position(boxer);
  EXPECT_NE(boxer.pin[0], boxer.pin[1]);
  EXPECT_TRUE(accepted(validate(boxer)));
  Layout split;
  split.cylinders = 2;
  split.bank_deg = {-45, 45};
  split.firing_deg = {0, 120};
  share_pins_by_position(split);
  EXPECT_NE(split.pin[0], split.pin[1]);
}

TEST(SharedPins, AreFoundThoughTheThrowsDifferByWholeTurns) {
  Layout layout;
  layout.cylinders = 2;
  layout.bank_deg = {-45, 45};
  layout.firing_deg = {0, 450};  // throws at -45 and -405 deg: the same direction
  share_pins_by_position(layout);
  EXPECT_EQ(layout.pin[0], layout.pin[1]);
  EXPECT_TRUE(accepted(validate(layout)));
}

TEST(SharedPins, OfOneCylinderIsItsOwnWhateverStoodThereBefore) {
  Layout layout;
  layout.cylinders = 1;
  layout.pin[0] = 3;
  share_pins_by_position(layout);
  EXPECT_EQ(layout.pin[0], 0);
  EXPECT_TRUE(accepted(validate(layout)));
}

TEST(SharedPins, OfALayoutThatValidateRefusesAreNoneOrStaySplit) {
  for (const double bank_deg : {1e7, -1e7, std::nan("")}) {  // angles that point nowhere
    Layout layout;
    layout.cylinders = 2;
    layout.bank_deg = {0, bank_deg};
    share_pins_by_position(layout);
    EXPECT_NE(layout.pin[0], layout.pin[1]) << bank_deg;
  }
  for (const int cylinders : {0, -1, kMaxCylinders + 1}) {
    Layout layout;
    layout.cylinders = cylinders;
    const Layout before = layout;
    share_pins_by_position(layout);
    EXPECT_EQ(layout.pin, before.pin) << cylinders;
  }
}

}  // namespace
}  // namespace crankloop::layout_test
