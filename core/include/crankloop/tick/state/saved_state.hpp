// Saves a state as bytes and loads it again. The bytes are written field by field, are the same on every machine, and
// are checked when they are loaded.
//
// What belongs here: the format of the bytes. What does not: the fields (tick/state/state_fields.hpp), where the caller
// stores the bytes. For a snapshot within one program, copy engine.state() instead.
//
//     offset 0   "CLST"
//            4   format version, 16 bits: kSavedStateForm
//            6   size of the scalar, 16 bits: 4 or 8
//            8   scene, 32 bits: CRC-32 of its settings
//           12   total size in bytes, 32 bits
//           16   the fields, the tables' fingerprint first
//       size-4   CRC-32 of all preceding bytes
//
// Least significant byte first; floating point as its IEEE 754 bits. The code only copies and compares numbers, so it
// may be compiled with a user's own flags.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>

#include <crankloop/engine.hpp>
#include <crankloop/status.hpp>
#include <crankloop/tick/state/misfire_counts.hpp>
#include <crankloop/tick/state/saved_bytes.hpp>
#include <crankloop/tick/state/state_fields.hpp>
#include <crankloop/tick/state/verify.hpp>

namespace crankloop {

/// Incremented whenever a release changes the fields or their format.
inline constexpr std::uint32_t kSavedStateForm = 5;

namespace detail {

inline constexpr std::size_t kSavedHeaderBytes = 16;
inline constexpr std::size_t kSavedChecksumBytes = 4;

/// A scene's settings as a number: with other settings the same fields mean something else.
template <class S>
[[nodiscard]] constexpr std::uint32_t scene_code() noexcept {
  Crc32 crc;
  crc.add(S::cylinders.capacity);
  crc.add(S::trains.capacity);
  crc.add(static_cast<std::uint32_t>(S::crank));
  crc.add(static_cast<std::uint32_t>(S::pressure));
  crc.add(static_cast<std::uint32_t>(S::valves));
  for (const bool answer : {S::load_ratio, S::rod_inertia, S::torque, S::mean_torque, S::forces, S::valve_results,
                            S::valve_gas, S::cam_phasing, S::bad_input_count}) {
    crc.add(std::uint32_t{answer});
  }
  if (S::starter || S::cylinder_cut) {  // scenes without them keep the code of earlier releases
    crc.add(std::uint32_t{S::starter});
    crc.add(std::uint32_t{S::cylinder_cut});
  }
  if (Needs<S>::gas) {
    crc.add(static_cast<std::uint32_t>(S::manifold));
    crc.add(static_cast<std::uint32_t>(S::combustion));
    crc.add(std::uint32_t{S::gas_results});
    if (S::boundaries) crc.add(std::uint32_t{1});
    if (S::crevice) crc.add(std::uint32_t{2});
    if (S::runners) crc.add(std::uint32_t{3});
  }
  // Answers of later releases, each with a mark of its own.
  if (S::cam_contact) crc.add(std::uint32_t{0x100});
  if (Needs<S>::charge_burn) crc.add(std::uint32_t{0x400});
  if (Needs<S>::knock) crc.add(std::uint32_t{0x500});
  if (S::walls) crc.add(std::uint32_t{0x600});
  if (Needs<S>::lambda) crc.add(0x1000 + S::lambda_parcels);
  if (S::cam_drag) crc.add(std::uint32_t{0x200});
  if (S::spring_modes > 0) crc.add(0x300 + S::spring_modes);
  if (S::misfire) crc.add(std::uint32_t{0x700});
  if (S::reluctor_samples > 0) crc.add(0x900 + S::reluctor_samples);
  if (S::sensor_faults) crc.add(std::uint32_t{0xA00});
  if (S::wheel_faults > 0) crc.add(0x800 + S::triggers.capacity), crc.add(S::wheel_faults);
  return crc.value();
}

}  // namespace detail

/// Size of a saved state in bytes; it depends on the scene, not on the engine.
template <class Real, class S>
inline constexpr std::size_t kSavedStateBytes = detail::kSavedHeaderBytes + detail::count_fields<Real, S>().in_bytes
                                                + detail::kSavedChecksumBytes;

/// Writes the engine's state; `size` is that of the buffer, at least kSavedStateBytes. Refuses an engine that is not
/// ready. O(state).
template <class Real, class S>
Status save_state(const Engine<Real, S>& engine, unsigned char* bytes, std::size_t size) noexcept {
  static_assert(detail::count_fields<Real, S>().in_memory == sizeof(State<Real, S>),
                "a field of State is missing in tick/state/state_fields.hpp");
  constexpr std::size_t all = kSavedStateBytes<Real, S>;
  if (engine.tables() == nullptr) return refuse("tables", Reason::missing_table);
  if (bytes == nullptr || size < all) return refuse("state.size", Reason::wrong_size);
  for (int i = 0; i < 4; ++i) bytes[i] = static_cast<unsigned char>("CLST"[i]);
  detail::StateWriter write(bytes + 4);
  write.put(kSavedStateForm, 2);
  write.put(std::uint32_t{sizeof(Real)}, 2);
  write.put(detail::scene_code<S>());
  write.put(static_cast<std::uint32_t>(all));
  detail::StateFields<Real, S>::visit(engine.state(), write);
  write.put(detail::crc32_of(bytes, all - detail::kSavedChecksumBytes));
  return {};
}

/// Restores a saved state: the engine continues with the same bits. `size` must be kSavedStateBytes. Refuses bytes that
/// are damaged or from another version, scene, scalar or other tables, and numbers that a step could not compute with
/// or that contradict one another; the engine then stays unchanged. Takes a State on the stack. O(state).
template <class Real, class S>
Status load_state(const unsigned char* bytes, std::size_t size, Engine<Real, S>& engine) noexcept {
  constexpr std::size_t all = kSavedStateBytes<Real, S>;
  if (engine.tables() == nullptr) return refuse("tables", Reason::missing_table);
  if (bytes == nullptr || size < detail::kSavedHeaderBytes) return refuse("state.size", Reason::wrong_size);
  if (std::memcmp(bytes, "CLST", 4) != 0) return refuse("state", Reason::damaged);
  detail::StateReader read(bytes + 4);
  std::uint32_t form = 0;
  std::uint32_t real_bytes = 0;
  std::uint32_t scene = 0;
  std::uint32_t said = 0;
  read.take(form, 2);
  read.take(real_bytes, 2);
  read.take(scene);
  read.take(said);
  if (form != kSavedStateForm) return refuse("state", Reason::other_version);
  if (real_bytes != sizeof(Real) || scene != detail::scene_code<S>()) return refuse("state", Reason::other_scene);
  if (size != all || said != all) return refuse("state.size", Reason::wrong_size);
  std::uint32_t checksum = 0;
  detail::StateReader(bytes + all - detail::kSavedChecksumBytes).take(checksum);
  if (checksum != detail::crc32_of(bytes, all - detail::kSavedChecksumBytes)) return refuse("state", Reason::damaged);

  State<Real, S> state{};
  detail::StateFields<Real, S>::visit(state, read);
  if (state.fingerprint != engine.state().fingerprint) return refuse("state.fingerprint", Reason::other_tables);
  if (!read.status().ok()) return read.status();
  if (const Status status = detail::fits(state, *engine.tables()); !status.ok()) return status;
  if constexpr (S::misfire) {
    for (MisfireRecord& record : state.misfire) detail::recount(record);
  }
  return engine.restore(state);
}

}  // namespace crankloop
