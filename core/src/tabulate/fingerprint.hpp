// Hash of a definition and its tick options.
#pragma once

#include <cstdint>
#include <cstring>

#include <crankloop/define/engine_definition.hpp>
#include <crankloop/tabulate/tabulate.hpp>

namespace crankloop::detail {

/// FNV-1a over 64-bit words, most significant byte first, so that byte order does not matter.
class Fingerprint {
 public:
  void add(std::uint64_t word) noexcept {
    for (int shift = 56; shift >= 0; shift -= 8) {
      hash_ ^= (word >> shift) & 0xFFu;
      hash_ *= 0x100000001B3u;
    }
  }
  void add(double number) noexcept {
    std::uint64_t bits;
    std::memcpy(&bits, &number, sizeof bits);
    add(bits);
  }
  void add(int number) noexcept { add(static_cast<std::uint64_t>(static_cast<std::int64_t>(number))); }

  [[nodiscard]] std::uint64_t value() const noexcept { return hash_; }

 private:
  std::uint64_t hash_ = 0xCBF29CE484222325u;
};

inline constexpr int kTableFormat = 8;  ///< incremented whenever the same definition gives other tables

/// Equal for equal definition, tick, options of the valves' steps, scalar, accuracy of the gas grid and table format,
/// on every machine and for any choice of sections. Trigger wheels are left out: a state holds nothing of them and
/// stays valid with others. So are the cams' contacts: a state holds but the largest stress of the cycle in progress.
[[nodiscard]] std::uint64_t fingerprint_of(const EngineDefinition& engine, const TickOptions& options,
                                           const TableReport& report, int scalar_bytes) noexcept;

}  // namespace crankloop::detail
