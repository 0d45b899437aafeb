// What a functional mock-up unit (FMU) keeps besides its engine, and both as bytes.
//
// What belongs here: what is stored, its form, what is refused. What does not: how it comes about (fmi/instance.hpp),
// the engine's own bytes (tick/state/saved_state.hpp).
#pragma once

#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <type_traits>

#include <crankloop/engine.hpp>
#include <crankloop/tick/state/saved_state.hpp>
#include <crankloop/variables.hpp>

namespace crankloop::fmi {

using namespace crankloop::detail;  // the list of variables

/// A refusal in words.
struct Message {
  char text[2048];  // all of it cleared would take as long as a tick

  Message() noexcept { text[0] = '\0'; }

  [[gnu::format(printf, 2, 3)]] void say(const char* format, ...) noexcept {
    std::va_list values;
    va_start(values, format);
    std::vsnprintf(text, sizeof text, format, values);
    va_end(values);
  }
};

/// What distinguishes one FMU from another.
using Token = std::uint32_t[4];

/// A token as FMI writes it: "{8-4-4-4-12}" of hexadecimal digits.
struct TokenText {
  char text[39];

  explicit TokenText(const Token& t) noexcept {
    std::snprintf(text, sizeof text, "{%08x-%04x-%04x-%04x-%04x%08x}", t[0], t[1] >> 16, t[1] & 0xFFFFu, t[2] >> 16,
                  t[2] & 0xFFFFu, t[3]);
  }
};

enum class Stage : std::uint32_t { instantiated, initializing, stepping, terminated };

inline constexpr std::uint32_t kEdgesShown = 8;
/// Whole numbers are signed in FMI 2: counts go on at 0 behind this one.
inline constexpr std::uint32_t kMaxWhole = 0x7FFF'FFFF;

[[nodiscard]] inline bool finite(double x) noexcept {
  return detail::within(x, -std::numeric_limits<double>::max(), std::numeric_limits<double>::max());
}

/// A trigger wheel's signal since the start; edges newest first.
struct WheelShown {
  struct Edge {
    double time_s = 0;
    std::uint32_t rises = 0;
  };
  std::uint32_t level = 0;
  std::uint32_t edges = 0;
  Edge edge[kEdgesShown] = {};

  /// The edges of a tick that began at `begin_s`.
  template <class Real, class S>
  [[gnu::noinline]] void note(const TriggerSignal<Real, S>& signal, double begin_s) noexcept {
    edges = (edges + signal.edge_count) & kMaxWhole;
    const std::uint32_t listed = signal.edge_count < S::trigger_edges ? signal.edge_count : S::trigger_edges;
    for (std::uint32_t e = 0; e < listed; ++e) {
      for (std::uint32_t k = kEdgesShown - 1; k > 0; --k) edge[k] = edge[k - 1];
      edge[0] = {begin_s + static_cast<double>(signal.edge[e].time_s), signal.edge[e].level};
    }
  }

  /// Whether it is what note() can leave.
  [[nodiscard]] bool is_one() const noexcept {
    bool good = level <= 1 && edges <= kMaxWhole;
    for (const Edge& e : edge) good = good && finite(e.time_s) && e.rises <= 1;
    return good;
  }
};

/// What a stored state has besides the engine; and both as bytes.
template <class Supply>
struct Kept {
  using Real = typename Supply::Real;
  using S = typename Supply::Scene;

  /// The largest engine of the scene.
  static constexpr EngineShape kLargest{S::cylinders.capacity, S::trains.capacity, S::triggers.capacity, 1.0};
  static constexpr std::size_t kMaxParameters = Supply::kMaxParameters > 0 ? Supply::kMaxParameters : 1;
  static constexpr std::size_t kMaxWheels = S::triggers.capacity > 0 ? S::triggers.capacity : 1;
  static constexpr std::size_t kSignals =
      kMaxWheels * (S::wheel_faults > 0 ? 2 : 1) +
      (S::reluctor_samples > 0 ? 1 : 0);  ///< healthy ones, then faulty, then the comparator
  struct Count {
    std::size_t inputs = 0, outputs = 0, output_bytes = 0;

    constexpr Count() noexcept {
      Input<double, S> in{};
      each_input<S>([this](const Variable&, auto&) { ++inputs; }, in, kLargest);
      const State<Real, S> state{};
      const Output<Real, S> out{};
      each_output<S>([this](const Variable&, auto& value) { ++outputs, output_bytes += sizeof value; }, state, out,
                     kLargest);
    }
  };
  static constexpr Count kCount{};

  Stage stage = Stage::instantiated;
  std::uint64_t ticks = 0;  ///< since the start
  double start_s = 0;
  double time_s = 0;  ///< where the last step ended
  double start_crank_deg = 0;
  double start_speed_rad_s = 0;
  std::uint32_t faults = 0;
  std::uint32_t fault_ticks = 0;
  double inputs[kCount.inputs]{};
  double parameters[kMaxParameters]{};
  WheelShown wheels[kSignals]{};
  bool input_is_old = true;  ///< whether the next step has to convert the inputs anew; the one that is not stored

  template <class AKept, class Visit>
  static constexpr void visit(AKept&& k, const Visit& visit) noexcept {
    visit(k.stage), visit(k.ticks), visit(k.start_s), visit(k.time_s);
    visit(k.start_crank_deg), visit(k.start_speed_rad_s), visit(k.faults), visit(k.fault_ticks);
    for (auto& x : k.inputs) visit(x);
    for (auto& x : k.parameters) visit(x);
    for (auto& w : k.wheels) {
      visit(w.level), visit(w.edges);
      for (auto& e : w.edge) visit(e.time_s), visit(e.rises);
    }
  }

  // ---- as bytes, least significant first: "CLFM", form, size, token, fields, outputs, engine, CRC-32 ----

  static constexpr std::uint32_t kForm = 1;
  static constexpr std::size_t kHeaderBytes = 28;
  static constexpr std::size_t kEngineBytes = kSavedStateBytes<Real, S>;
  [[nodiscard]] static constexpr std::size_t count_bytes() noexcept {
    std::size_t bytes = kHeaderBytes + kCount.output_bytes + kEngineBytes + kSavedChecksumBytes;
    visit(Kept{}, [&bytes](const auto& x) { bytes += sizeof x; });
    return bytes;
  }

  void save(unsigned char* bytes, const Token& token, const Engine<Real, S>& engine) const noexcept {
    constexpr std::size_t kSummed = count_bytes() - kSavedChecksumBytes;
    for (int i = 0; i < 4; ++i) bytes[i] = static_cast<unsigned char>("CLFM"[i]);
    StateWriter write(bytes + 4);
    write.put(kForm);
    write.put(static_cast<std::uint32_t>(count_bytes()));
    for (const std::uint32_t word : token) write.put(word);
    visit(*this, [&write](const auto& x) { write.put(x); });
    each_output<S>([&write](const Variable&, const auto& x) { write.put(x); }, engine.state(), engine.output(),
                   kLargest);
    unsigned char* last = bytes + kSummed - kEngineBytes;
    if (!save_state(engine, last, kEngineBytes).ok()) std::memset(last, 0, kEngineBytes);  // not started yet
    StateWriter(bytes + kSummed).put(crc32_of(bytes, kSummed));
  }

  /// Whether they are the bytes of a state of the FMU with this token.
  static bool check(const unsigned char* bytes, const Token& token, Message& why) noexcept {
    constexpr std::size_t kSummed = count_bytes() - kSavedChecksumBytes;
    if (std::memcmp(bytes, "CLFM", 4) != 0) return why.say("the bytes are no saved state"), false;
    StateReader read(bytes + 4);
    const auto next_is = [](auto&& from, std::uint32_t expected) {
      std::uint32_t word = 0;
      from.take(word);
      return word == expected;
    };
    if (!next_is(read, kForm) || !next_is(read, static_cast<std::uint32_t>(count_bytes())))
      return why.say("the state was saved by another version"), false;
    for (const std::uint32_t word : token) {
      if (!next_is(read, word)) return why.say("the state is of another FMU"), false;
    }
    return next_is(StateReader(bytes + kSummed), crc32_of(bytes, kSummed)) || (why.say("the state is damaged"), false);
  }

  /// All but the engine. Refused: what is read so far counts for nothing.
  bool read(const unsigned char* bytes, const Token& token, Output<Real, S>& output, Message& why) noexcept {
    if (!check(bytes, token, why)) return false;
    StateReader from(bytes + kHeaderBytes);
    visit(*this, [&from](auto& x) { from.take(x); });
    bool good = stage <= Stage::terminated && finite(start_s) && finite(time_s) && fault_ticks <= kMaxWhole;
    for (const WheelShown& w : wheels) good = good && w.is_one();
    [[maybe_unused]] State<Real, S> unused{};
    const auto take = [&from, &good](const Variable&, auto& x) {
      from.take(x);
      if constexpr (std::is_floating_point_v<std::remove_reference_t<decltype(x)>>)
        good = good && finite(static_cast<double>(x));
    };
    each_output<S>(take, unused, output, kLargest);
    return good || (why.say("the state is damaged"), false);
  }
  /// The engine, which has tables already; false where it is refused.
  [[nodiscard]] static bool read(const unsigned char* bytes, Engine<Real, S>& engine) noexcept {
    return load_state(bytes + count_bytes() - kSavedChecksumBytes - kEngineBytes, kEngineBytes, engine).ok();
  }
};

}  // namespace crankloop::fmi
