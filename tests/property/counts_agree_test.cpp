// The scene for exactly N cylinders, loops unrolled, gives the same bits as the one for up to sixteen.
#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "support/both_reals.hpp"
#include "support/scene_record.hpp"
#include "support/status.hpp"

namespace crankloop::counts_agree_test {
namespace {

using namespace tick_test;

constexpr unsigned kTorques = unsigned{kTorque} | kMeanTorque;

template <unsigned Groups, PressureGiven Source, bool ByLoad, std::uint32_t... N, class Real>
void expect_exact_counts_to_agree(const FullTables<Real>& tables) {
  const Record up_to = record_of<Real, Asking<Groups, Source, ByLoad>>(tables);
  const auto compare = [&](const Record& exact) { expect_same(exact, up_to, Groups); };
  const std::uint32_t cylinders = tables.drive().cylinders;
  int compared = 0;
  ((N == cylinders
        ? (compare(record_of<Real, Asking<Groups, Source, ByLoad, CrankGiven::speed, N>>(tables)), ++compared)
        : 0),
   ...);
  ASSERT_EQ(compared, 1) << cylinders << " cylinders";
}

template <class Real>
void with_engine(const std::vector<double>& firing_deg, void (*expect)(const FullTables<Real>&)) {
  SCOPED_TRACE(firing_deg.size());
  FullTables<Real> tables;
  ASSERT_TRUE(accepted(tables.build(with_cylinders(single_495(), firing_deg), kLifeTick_s, kLifeGasSegments)));
  expect(tables);
}

TEST(CountsAgree, InEveryGroup) {
  for (const std::vector<double>& firing_deg :
       std::vector<std::vector<double>>{{0},
                                        {0, 480, 240},
                                        {0, 540, 180, 360},
                                        {0, 90, 450, 360.5},
                                        {0, 480, 240, 600, 120, 360},
                                        {0, 90, 270, 180, 630, 540, 450, 360}}) {
    with_engine<float>(firing_deg,
                       expect_exact_counts_to_agree<kAllGroups, PressureGiven::by_table, false, 1, 3, 4, 6, 8>);
  }
}

template <class Real>
class CountsAgree4 : public ::testing::Test {};
TYPED_TEST_SUITE(CountsAgree4, BothReals, RealName);

TYPED_TEST(CountsAgree4, WithTorqueByLoadAndFromMeasuredPressures) {
  for (const std::vector<double>& firing_deg :
       std::vector<std::vector<double>>{{0, 540, 180, 360}, {0, 90, 450, 360.5}}) {
    with_engine<TypeParam>(firing_deg, expect_exact_counts_to_agree<kTorques, PressureGiven::by_table, true, 4>);
    with_engine<TypeParam>(firing_deg,
                           expect_exact_counts_to_agree<kTorques | kForces, PressureGiven::by_input, false, 4>);
  }
}

}  // namespace
}  // namespace crankloop::counts_agree_test
