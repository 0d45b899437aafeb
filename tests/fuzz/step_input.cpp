// Any bytes as inputs of steps: every output is finite, faults are known ones, and after a good input there are none.
#include "fuzzed_engine.hpp"

using namespace crankloop;

namespace {

constexpr std::uint32_t kKnown = 2 * kFaultOverspeed - 1;

template <class Real, class S>
void step_on(const std::uint8_t* data, std::size_t size) {
  static fuzz::Rig<Real, S> rig;
  using Input = typename Engine<Real, S>::Input;
  static_assert(std::is_trivially_copyable_v<Input>, "any bytes are an input");
  fuzz::must(rig.engine.init(rig.tables->tables()).ok(), "an engine starts again");
  fuzz::Bytes bytes(data, size);
  for (int i = 0; i < 2000 && !bytes.empty(); ++i) {
    Input in;
    bytes.fill(&in, sizeof in);
    fuzz::must_be_finite(rig.engine.step(in));
    fuzz::must((rig.engine.output().faults & ~kKnown) == 0, "only known faults");
    fuzz::must((rig.engine.output().faults & kFaultNotReady) == 0, "an engine stays ready");
  }
  Input good{};
  if constexpr (S::crank == CrankGiven::phase) rig.engine.step(good);  // it may jump there
  rig.engine.step(good);
  fuzz::must((rig.engine.output().faults & ~std::uint32_t{kFaultEventBudget}) == 0, "a good input sets no fault");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  step_on<float, fuzz::Everything>(data, size);
  step_on<double, fuzz::Everything>(data, size);
  step_on<float, fuzz::EverythingMeasured>(data, size);
  return 0;
}
