// Any bytes as a saved state: refused, and then nothing has changed, or an engine that steps on in finite numbers.
//
// First byte odd: the bytes as they are. Even: a good state with changed bytes, (place 0 to 65 535, new byte) each, and
// with a checksum that is right again, for a forger would see to that.
#include <crankloop/tick/state/saved_state.hpp>

#include <vector>

#include "fuzzed_engine.hpp"

using namespace crankloop;

namespace {

template <class Real, class S>
void load_and_step(const std::uint8_t* data, std::size_t size) {
  static fuzz::Rig<Real, S> rig;
  static const std::vector<unsigned char> good = [] {
    typename Engine<Real, S>::Input in;
    for (int i = 0; i < 300; ++i) {
      if constexpr (S::crank == CrankGiven::speed) in.speed_rad_s = 500;
      if constexpr (S::crank == CrankGiven::phase) in.crank += Phase{std::uint64_t{1} << 57};
      rig.engine.step(in);
    }
    std::vector<unsigned char> bytes(kSavedStateBytes<Real, S>);
    fuzz::must(save_state(rig.engine, bytes.data(), bytes.size()).ok(), "a state is saved");
    return bytes;
  }();
  std::vector<unsigned char> bytes(data + 1, data + size);
  if (data[0] % 2 == 0) {
    fuzz::Bytes changes(data + 1, size - 1);
    bytes = good;
    while (!changes.empty()) {
      const std::size_t at = changes.take<std::uint16_t>() % (bytes.size() - detail::kSavedChecksumBytes);
      bytes[at] = changes.take<std::uint8_t>();
    }
    const std::size_t end = bytes.size() - detail::kSavedChecksumBytes;
    const std::uint32_t checksum = detail::crc32_of(bytes.data(), end);
    for (std::size_t i = 0; i < 4; ++i) bytes[end + i] = static_cast<unsigned char>(checksum >> (8 * i));
  }
  typename Engine<Real, S>::Input in;
  const State<Real, S> before = rig.engine.state();
  if (!load_state(bytes.data(), bytes.size(), rig.engine).ok()) {
    fuzz::must(std::memcmp(&before, &rig.engine.state(), sizeof before) == 0, "a refused state changes nothing");
    return;
  }
  for (int i = 0; i < 40; ++i) {
    if constexpr (S::crank == CrankGiven::speed) in.speed_rad_s = 300;
    if constexpr (S::crank == CrankGiven::phase) in.crank += Phase{std::uint64_t{1} << 56};
    fuzz::must_be_finite(rig.engine.step(in));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  load_and_step<float, fuzz::Everything>(data, size);
  load_and_step<double, fuzz::EverythingMeasured>(data, size);
  return 0;
}
