// The list of variables has every number of a step's inputs and outputs: what it lacks C and FMUs would lack, without a
// word from the compiler.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <crankloop/scenes.hpp>
#include <crankloop/variables.hpp>

namespace crankloop::variables_test {
namespace {

/// Which bytes of an object have been visited.
class Bytes {
 public:
  Bytes(const void* first, const void* end)
      : first_{static_cast<const unsigned char*>(first)},
        visited_(static_cast<std::size_t>(static_cast<const unsigned char*>(end) - first_), false) {}

  template <class Member>
  void visit(const Member& member) {
    const std::ptrdiff_t at = reinterpret_cast<const unsigned char*>(&member) - first_;
    if (at < 0 || static_cast<std::size_t>(at) >= visited_.size()) return;  // of the state
    for (std::size_t i = 0; i < sizeof member; ++i) visited_[static_cast<std::size_t>(at) + i] = true;
  }
  /// Where they begin that were not.
  [[nodiscard]] std::vector<std::size_t> left_out() const {
    std::vector<std::size_t> offsets;
    for (std::size_t i = 0; i < visited_.size(); ++i)
      if (!visited_[i] && (i == 0 || visited_[i - 1])) offsets.push_back(i);
    return offsets;
  }

 private:
  const unsigned char* first_;
  std::vector<bool> visited_;
};

/// As many as a scene has room for. In float all members are words, and no byte is padding.
template <class S>
constexpr detail::EngineShape full_shape() {
  return {S::cylinders.capacity, S::trains.capacity, S::triggers.capacity, 1000};
}

template <class S>
class VariablesOf : public testing::Test {};

struct MeasuredBreathing : scenes::Breathing {
  static constexpr CrankGiven crank = CrankGiven::phase;
  static constexpr Count triggers = up_to<2>;
  static constexpr std::uint32_t reluctor_samples = 16;
  static constexpr bool controller_names = true;
  static constexpr bool boundaries = false;  // with them its inputs end in padding
};
struct GivenManifolds : scenes::Breathing {
  static constexpr Manifold manifold = Manifold::given;
  static constexpr bool boundaries = false;
  static constexpr std::uint32_t lambda_parcels = 0;
};
struct LoadedCams : scenes::Breathing {
  static constexpr CrankGiven crank = CrankGiven::torque;
  static constexpr bool cam_contact = true;
  static constexpr bool cam_torque = true;
  static constexpr bool cam_drag = true;
};
using Scenes =
    testing::Types<scenes::Whole, scenes::Breathing, MeasuredBreathing, GivenManifolds, LoadedCams, scenes::FreeRunning,
                   scenes::BreathingFree, scenes::MeasuredMotion, scenes::TorqueByTable, scenes::TorqueByPressure>;
struct NumberOfScene {
  template <class S>
  static std::string GetName(int i) {
    return std::to_string(i);
  }
};
TYPED_TEST_SUITE(VariablesOf, Scenes, NumberOfScene);

TYPED_TEST(VariablesOf, AStepsOutputAreAllOfItsNumbers) {
  using S = TypeParam;
  const Output<float, S> out{};
  const State<float, S> state{};
  Bytes bytes(&out, &out.faults);  // which every format has by a name of its own, and padding follows
  const auto visit = [&bytes](const detail::Variable&, const auto& member) { bytes.visit(member); };
  detail::each_output<S>(visit, state, out, full_shape<S>());
  detail::each_event<S>(visit, out, full_shape<S>());
  if constexpr (detail::Needs<S>::crank_dynamics) bytes.visit(out.crank);  // crank_deg, taken from the state
  EXPECT_EQ(bytes.left_out(), std::vector<std::size_t>{}) << "offsets in Output of members without a row";
}

TYPED_TEST(VariablesOf, AStepsInputAreAllOfItsNumbers) {
  using S = TypeParam;
  const Input<float, S> in{};
  Bytes bytes(&in, &in + 1);
  detail::each_input<S>([&bytes](const detail::Variable&, const auto& member) { bytes.visit(member); }, in,
                        full_shape<S>());
  EXPECT_EQ(bytes.left_out(), std::vector<std::size_t>{}) << "offsets in Input of members without a row";
}

}  // namespace
}  // namespace crankloop::variables_test
