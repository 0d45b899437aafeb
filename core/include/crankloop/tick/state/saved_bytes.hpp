// Numbers as bytes, least significant first, and their checksum.
//
// What belongs here: how one field is written and read back. What does not: which fields (tick/state/state_fields.hpp),
// header and checksum (tick/state/saved_state.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include <crankloop/assert.hpp>
#include <crankloop/phase.hpp>
#include <crankloop/status.hpp>
#include <crankloop/tick/state/field_ranges.hpp>

namespace crankloop::detail {

/// CRC-32 of IEEE 802.3, half a byte at a time. It detects any change confined to 32 successive bits, so any changed
/// byte.
class Crc32 {
 public:
  constexpr void add(unsigned char byte) noexcept {
    sum_ ^= byte;
    for (int half = 0; half < 2; ++half) sum_ = sum_ >> 4 ^ kOfNibble[sum_ & 0xFu];
  }
  constexpr void add(std::uint32_t word) noexcept {
    for (int shift = 0; shift < 32; shift += 8) add(static_cast<unsigned char>(word >> shift));
  }
  [[nodiscard]] constexpr std::uint32_t value() const noexcept { return ~sum_; }

 private:
  static constexpr std::uint32_t kOfNibble[16] = {
      0x00000000, 0x1DB71064, 0x3B6E20C8, 0x26D930AC, 0x76DC4190, 0x6B6B51F4, 0x4DB26158, 0x5005713C,
      0xEDB88320, 0xF00F9344, 0xD6D6A3E8, 0xCB61B38C, 0x9B64C2B0, 0x86D3D2D4, 0xA00AE278, 0xBDBDF21C};
  std::uint32_t sum_ = 0xFFFF'FFFFu;
};

[[nodiscard]] constexpr std::uint32_t crc32_of(const unsigned char* bytes, std::size_t size) noexcept {
  Crc32 crc;
  for (std::size_t i = 0; i < size; ++i) crc.add(bytes[i]);
  return crc.value();
}

template <class T>
[[nodiscard]] std::uint64_t word_of(const T& x) noexcept {
  if constexpr (sizeof(T) == 8) {
    std::uint64_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    return bits;
  } else {
    std::uint32_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    return bits;
  }
}
template <class T>
void set_bits(T& x, std::uint64_t bits) noexcept {
  if constexpr (sizeof(T) == 8) {
    std::memcpy(&x, &bits, sizeof x);
  } else {
    const auto low = static_cast<std::uint32_t>(bits);
    std::memcpy(&x, &low, sizeof x);
  }
}
[[nodiscard]] inline std::uint64_t word_of(const Phase& x) noexcept { return x.units(); }
inline void set_bits(Phase& x, std::uint64_t bits) noexcept { x = Phase{bits}; }

/// Writes fields one after the other.
class StateWriter {
 public:
  explicit StateWriter(unsigned char* at) noexcept : at_{at} {}

  template <class T>
  void put(const T& x, std::size_t bytes = sizeof(T)) noexcept {
    CRANKLOOP_ASSERT(bytes >= 1 && bytes <= sizeof(T));
    const std::uint64_t bits = word_of(x);
    for (std::size_t i = 0; i < bytes; ++i) *at_++ = static_cast<unsigned char>(bits >> (8 * i));
  }

  void group(const char*) noexcept {}
  template <class Real>
  void number(const Real& x, Real, Real) noexcept {
    put(x);
  }
  template <class Base>
  void sum(const Base& x, double) noexcept {
    put(x);
  }
  void wide(const std::uint64_t& x) noexcept { put(x); }
  void phase(const Phase& x) noexcept { put(x); }
  void signed_wide(const std::uint64_t& x, std::uint64_t) noexcept { put(x); }
  template <class Word>
  void word(const Word& x, std::uint32_t) noexcept {
    put(x);
  }
  template <class T>
  void spare(const T&) noexcept {}

 private:
  unsigned char* at_;
};

/// Reads fields back; status() is that of the first field out of its range.
class StateReader {
 public:
  explicit StateReader(const unsigned char* at) noexcept : at_{at} {}

  [[nodiscard]] Status status() const noexcept { return ranges_.status(); }

  template <class T>
  void take(T& x, std::size_t bytes = sizeof(T)) noexcept {
    CRANKLOOP_ASSERT(bytes >= 1 && bytes <= sizeof(T));
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < bytes; ++i) bits |= std::uint64_t{*at_++} << (8 * i);
    set_bits(x, bits);
  }

  void group(const char* name) noexcept { ranges_.group(name); }
  template <class Real>
  void number(Real& x, Real least, Real most) noexcept {
    take(x), ranges_.number(x, least, most);
  }
  template <class Base>
  void sum(Base& x, double most) noexcept {
    take(x), ranges_.sum(x, most);
  }
  void wide(std::uint64_t& x) noexcept { take(x); }
  void phase(Phase& x) noexcept { take(x); }
  void signed_wide(std::uint64_t& x, std::uint64_t most) noexcept { take(x), ranges_.signed_wide(x, most); }
  template <class Word>
  void word(Word& x, std::uint32_t most) noexcept {
    take(x), ranges_.word(x, most);
  }
  template <class T>
  void spare(T&) noexcept {}

 private:
  const unsigned char* at_;
  FieldRanges ranges_;
};

}  // namespace crankloop::detail
