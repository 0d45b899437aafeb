// Several valves at once, one in each lane: what lanes hold side by side, and how it is read.
//
// What belongs here: a lane's regime, body and cam, rows of numbers for each lane. What does not: the plain step of a
// block of lanes (lane_blocks.hpp), the arithmetic of a step (valve.hpp), which valves an engine has
// (elastic_valves.hpp).
#pragma once

#include <cstddef>
#include <cstring>
#include <initializer_list>

#include <crankloop/assert.hpp>
#include <crankloop/tick/lanes.hpp>
#include <crankloop/tick/valve/cam_ticks.hpp>
#include <crankloop/tick/valve/valve.hpp>
#include <crankloop/tick/valve/valves_work.hpp>

#if CRANKLOOP_ABREAST
namespace crankloop::detail {

// ---- between lanes and memory ------------------------------------------------------------------------------------

template <class Lanes>
[[nodiscard, gnu::always_inline]] inline Lanes larger(const Lanes& a, const Lanes& b) noexcept {
  return a > b ? a : b;
}
/// Raises each lane's number to x, and returns in which lanes that changed it.
template <class Lanes>
[[nodiscard, gnu::always_inline]] inline auto raise(float* number, const Lanes& x) noexcept {
  const Lanes before = load<Lanes>(number);
  const auto more = x > before;
  store<Lanes>(number, more ? x : before);
  return more;
}

/// Rows of two, four or six numbers for each of four lanes, from and to registers of one number of each lane.
[[gnu::always_inline]] inline void store_lanes(const Four& a, const Four& b, float* const (&to)[4]) noexcept {
  using Two = double __attribute__((vector_size(16)));
  const Two low = reinterpret_cast<Two>(shuffled<0, 4, 1, 5>(a, b)),
            high = reinterpret_cast<Two>(shuffled<2, 6, 3, 7>(a, b));
  const double pairs[4] = {low[0], low[1], high[0], high[1]};
  for (int i = 0; i < 4; ++i) std::memcpy(to[i], &pairs[i], sizeof pairs[i]);
}
[[gnu::always_inline]] inline void load_lanes(const float* const (&from)[4], Four& a, Four& b) noexcept {
  using Two = double __attribute__((vector_size(16)));
  double pairs[4];
  for (int i = 0; i < 4; ++i) std::memcpy(&pairs[i], from[i], sizeof pairs[i]);
  const Four low = reinterpret_cast<Four>(Two{pairs[0], pairs[1]}),
             high = reinterpret_cast<Four>(Two{pairs[2], pairs[3]});
  a = shuffled<0, 2, 4, 6>(low, high), b = shuffled<1, 3, 5, 7>(low, high);
}
[[gnu::always_inline]] inline void store_lanes(const Four& a, const Four& b, const Four& c, const Four& d,
                                               float* const (&to)[4]) noexcept {
  Four x[4] = {a, b, c, d};
  transpose(x);
  for (int i = 0; i < 4; ++i) store<Four>(to[i], x[i]);
}
[[gnu::always_inline]] inline void store_lanes(const Four (&x)[6], float* const (&to)[4]) noexcept {
  store_lanes(x[0], x[1], x[2], x[3], to);
  store_lanes(x[4], x[5], {to[0] + 4, to[1] + 4, to[2] + 4, to[3] + 4});
}
[[gnu::always_inline]] inline void load_lanes(const float* const (&from)[4], Four (&x)[6]) noexcept {
  Four y[4] = {load<Four>(from[0]), load<Four>(from[1]), load<Four>(from[2]), load<Four>(from[3])};
  transpose(y);
  for (int i = 0; i < 4; ++i) x[i] = y[i];
  load_lanes({from[0] + 4, from[1] + 4, from[2] + 4, from[3] + 4}, x[4], x[5]);
}
#if defined(__AVX__)
[[nodiscard, gnu::always_inline]] inline Eight joined(const Four& low, const Four& high) noexcept {
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}
[[nodiscard, gnu::always_inline]] inline Four half(const Eight& x, int which) noexcept {
  Four f;
  std::memcpy(&f, reinterpret_cast<const char*>(&x) + which * 16, sizeof f);
  return f;
}
[[gnu::always_inline]] inline void load_lanes(const float* const (&from)[8], Eight (&x)[6]) noexcept {
  Four low[6], high[6];
  load_lanes({from[0], from[1], from[2], from[3]}, low);
  load_lanes({from[4], from[5], from[6], from[7]}, high);
  for (int i = 0; i < 6; ++i) x[i] = joined(low[i], high[i]);
}
[[gnu::always_inline]] inline void store_lanes(const Eight& a, const Eight& b, float* const (&to)[8]) noexcept {
  store_lanes(half(a, 0), half(b, 0), {to[0], to[1], to[2], to[3]});
  store_lanes(half(a, 1), half(b, 1), {to[4], to[5], to[6], to[7]});
}
[[gnu::always_inline]] inline void store_lanes(const Eight& a, const Eight& b, const Eight& c, const Eight& d,
                                               float* const (&to)[8]) noexcept {
  store_lanes(half(a, 0), half(b, 0), half(c, 0), half(d, 0), {to[0], to[1], to[2], to[3]});
  store_lanes(half(a, 1), half(b, 1), half(c, 1), half(d, 1), {to[4], to[5], to[6], to[7]});
}
[[gnu::always_inline]] inline void store_lanes(const Eight (&x)[6], float* const (&to)[8]) noexcept {
  store_lanes(x[0], x[1], x[2], x[3], to);
  store_lanes(x[4], x[5], {to[0] + 4, to[1] + 4, to[2] + 4, to[3] + 4, to[4] + 4, to[5] + 4, to[6] + 4, to[7] + 4});
}
#endif

// ---- what lanes hold ---------------------------------------------------------------------------------------------

/// A number of each lane, read where it is used: a regime has more of them than there are registers.
template <class Lanes, bool Aligned>
struct InMemory {
  const float* at;

  [[gnu::always_inline]] operator Lanes() const noexcept { return Aligned ? load_aligned<Lanes>(at) : load<Lanes>(at); }
  friend Lanes operator*(const InMemory& a, const Lanes& b) noexcept { return Lanes(a) * b; }
  friend Lanes operator+(const InMemory& a, const Lanes& b) noexcept { return Lanes(a) + b; }
  friend auto operator>(const Lanes& a, const InMemory& b) noexcept { return a > Lanes(b); }
  friend auto operator<(const Lanes& a, const InMemory& b) noexcept { return a < Lanes(b); }
};

/// The regimes of a block of lanes.
template <class Lanes, class Work>
[[nodiscard, gnu::always_inline]] inline auto regimes_at(const Work& w, std::size_t first) noexcept {
  using Held = InMemory<Lanes, Work::kBlocksAligned>;
  int number = 0;
  const auto next = [&] { return Held{&w.constants[number++][first]}; };
  RegimeStep<Held> r;
  for (StepRow<Held>* row : {&r.lift, &r.velocity}) {
    row->rest = next(), row->gas = next(), row->gas_rise = next(), row->gap = next(), row->rise = next();
    row->from = next(), row->to = next(), row->lift = next(), row->velocity = next();
  }
  ForceRow<Held>& a = r.acceleration;
  a.rest = next(), a.gas = next(), a.lift = next(), a.velocity = next(), a.gap = next(), a.gap_speed = next();
  for (ContactGuard<Held>* guard : {&r.train, &r.seat})
    guard->sign = next(), guard->lag_s = next(), guard->least_m = next();
  r.rest_m = next(), r.rest_m_s = next();
  r.middle.lift = next(), r.middle.velocity = next();
  return r;
}

/// Loads a lane with a regime's constants.
template <class Work>
[[gnu::noinline]] inline void set_lane(Work& w, std::size_t lane, const RegimeStep<float>& regime) noexcept {
  static_assert(sizeof w.constants / sizeof w.constants[0] * sizeof(float) == offsetof(RegimeStep<float>, decoupled_m));
  const char* from = reinterpret_cast<const char*>(&regime);
  for (auto& numbers : w.constants) std::memcpy(&numbers[lane], from, sizeof(float)), from += sizeof(float);
}

/// Loads a lane with what it needs of its valve's body.
template <class S>
inline void set_body_of_lane(ValvesWork<float, S>& w, std::size_t lane, const ValveMotion<float>& motion) noexcept {
  if constexpr (Needs<S>::valve_push)
    w.head_area_m2[lane] = motion.body.head_area_m2, w.per_seat_N_m[lane] = motion.per_seat_N_m;
  if constexpr (S::valve_forces) {
    const ValveBody<float>& b = motion.body;
    w.train_N_m[lane] = b.train_N_m, w.train_Ns_m[lane] = b.train_Ns_m;
    w.preload_N[lane] = b.preload_N, w.seat_N_m[lane] = b.seat_N_m, w.seat_Ns_m[lane] = b.seat_Ns_m;
    w.rocker_mass_kg[lane] = b.rocker_mass_kg;
  }
  (void)w, (void)lane, (void)motion;
}

/// Flipped in fractions of a degree, so that the comparison of signed words, which every processor has, orders them.
inline constexpr std::uint32_t kSignBit = 0x8000'0000u;

/// Loads a lane with what it needs of its cam.
template <class Work>
inline void set_cam_of_lane(Work& w, std::size_t lane, const LiftCurve<float>& curve, std::uint32_t cylinder) noexcept {
  const Cell cell = LiftCurve<float>::cell(curve.opens[cylinder]);
  w.segments[lane] = curve.at;
  w.degrees[lane] = curve.segments;
  w.opens_degree[lane] = cell.degree;
  w.opens_into[lane] = cell.into ^ kSignBit;
}

/// How the lanes' cams turn in a tick: all alike, or each its own way where phasers turn them.
template <class S>
struct LanesTick {
  static constexpr std::size_t kRoom = S::cam_phasing ? kLaneRoom<S> : 1;
  float deg[kRoom], deg_per_s[kRoom];
  std::uint32_t degree[kRoom], into[kRoom];  ///< where the train's cams stand, as VectorLanes has where lobes begin

  void set(std::size_t lane, const CamTick<float>& tick) noexcept {
    CRANKLOOP_ASSERT(lane < kRoom);
    const Cell cell = LiftCurve<float>::cell(tick.phase);
    deg[lane] = tick.cam.deg, deg_per_s[lane] = tick.cam.deg_per_s;
    degree[lane] = cell.degree, into[lane] = cell.into ^ kSignBit;
  }
  template <class Lanes>
  [[nodiscard, gnu::always_inline]] static Lanes of(const float (&x)[kRoom], std::size_t first) noexcept {
    if constexpr (S::cam_phasing) return load<Lanes>(x + first);
    (void)first;
    return spread<Lanes>(x[0]);
  }
  template <class Lanes>
  [[nodiscard, gnu::always_inline]] static BitsOf<Lanes> words(const std::uint32_t (&x)[kRoom],
                                                               std::size_t first) noexcept {
    if constexpr (S::cam_phasing) return load_words<Lanes>(x + first);
    (void)first;
    return BitsOf<Lanes>{} + x[0];
  }
};

/// Forces of gas and surging springs on lanes over a tick, where blocks do not compute them.
template <class S>
struct GasOfLanes {
  float from_N[kLaneRoom<S>], to_N[kLaneRoom<S>];
};
/// Whether blocks compute them: then a block's valves are of one train, their cylinders side by side.
template <class S>
inline constexpr bool kGasInBlocks =
    Needs<S>::valve_gas_held && !Needs<S>::surge && S::cylinders.capacity % kLanesOf<WidestLanes> == 0;

/// Where lanes' cams stand in the middle of a wide tick.
template <class S>
struct MiddleOfLanes {
  LanesTick<S> middle;
};

/// The valves of a block of lanes.
template <class Lanes>
struct ValvesOf {
  std::size_t valve[kLanesOf<Lanes>];

  template <class Valves>
  [[gnu::always_inline]] ValvesOf(const Valves& valves, std::size_t first) noexcept {
    for (std::size_t i = 0; i < kLanesOf<Lanes>; ++i) valve[i] = valves.valve_in(first + i);
  }
  /// A number of each.
  [[gnu::always_inline]] void store(const Lanes& x, float* to) const noexcept {
    for (int i = 0; i < kLanesOf<Lanes>; ++i) to[valve[i]] = x[i];
  }
};
/// Where each valve has its row of floats.
template <std::size_t Floats, class Lanes>
struct RowsOf {
  float* at[kLanesOf<Lanes>];

  [[gnu::always_inline]] RowsOf(const ValvesOf<Lanes>& of, float* base) noexcept {
    for (int i = 0; i < kLanesOf<Lanes>; ++i) at[i] = base + Floats * of.valve[i];
  }
};

/// Where each lane's cam stands: a segment of its lift, and how far into it.
template <class Lanes>
struct LanesPlace {
  std::uint32_t segment[kLanesOf<Lanes>];  ///< outside the lobe the last one
  Lanes u;
};

/// The lift of each lane's cam: bit for bit that of LiftCurve::read at LiftCurve::cell. A cam's angle is the train's
/// less that where its lobe begins; so is its degree, except for a borrow and a turn.
template <class Lanes, class S>
[[nodiscard, gnu::always_inline]] inline Lift<Lanes> read_lanes(const ValvesWork<float, S>& w, std::size_t first,
                                                                const LanesTick<S>& tick,
                                                                LanesPlace<Lanes>& place) noexcept {
  using Words32 = BitsOf<Lanes>;
  using Signed = decltype(Lanes{} < Lanes{});
  const auto words = [&](const std::uint32_t* from) { return load_words<Lanes, VectorLanes<S>::kBlocksAligned>(from); };
  const Words32 cams_into = tick.template words<Lanes>(tick.into, first);
  const Words32 opens_into = words(&w.opens_into[first]);
  const Words32 into = cams_into - opens_into;
  Signed degree = reinterpret_cast<Signed>(tick.template words<Lanes>(tick.degree, first)) -
                  reinterpret_cast<Signed>(words(&w.opens_degree[first])) +
                  (reinterpret_cast<Signed>(cams_into) < reinterpret_cast<Signed>(opens_into));
  degree += (degree < 0) & kDegreesPerTurn;
  degree = smaller<Lanes>(degree, reinterpret_cast<Signed>(words(&w.degrees[first])));
  std::memcpy(place.segment, &degree, sizeof place.segment);
  CRANKLOOP_ASSERT(place.segment[0] <= std::uint32_t{kDegreesPerTurn});
  static_assert(sizeof(LiftSegment<float>) == 3 << 3);
  std::uint32_t bytes[kLanesOf<Lanes>];
  const auto of_segments = (degree + degree + degree) << 3;
  std::memcpy(bytes, &of_segments, sizeof bytes);
  const float* from[kLanesOf<Lanes>];
  for (int i = 0; i < kLanesOf<Lanes>; ++i)
    from[i] = reinterpret_cast<const LiftSegment<float>*>(
                  reinterpret_cast<const char*>(w.segments[first + static_cast<std::size_t>(i)]) + bytes[i])
                  ->c;
  Lanes c[6];
  load_lanes(from, c);
  const Lanes u = place.u = __builtin_convertvector(reinterpret_cast<Signed>(into >> 8), Lanes) * 0x1p-24F;
  Lanes slope = c[5];
  Lanes value = c[4] + u * slope;
  for (int i = 3; i >= 0; --i) {  // as LiftCurve::read
    slope = value + u * slope;
    value = c[i] + u * value;
  }
  return {value, slope};
}

}  // namespace crankloop::detail
#endif
