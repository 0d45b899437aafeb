// What the program carries of a page: its scripts, style and frame, the modules where they were there when it was
// built.
//
// What belongs here: bytes by name (port/wasm/embed.cmake writes them). What does not: how they become a page
// (page.cpp).
#pragma once

#include <cstddef>
#include <string_view>

namespace crankloop::program {

struct PagePart {
  const char* name;  ///< "main.mjs", "../wasi.mjs", "engine.wasm" (deflated)
  const unsigned char* bytes;
  std::size_t size;

  [[nodiscard]] std::string_view text() const noexcept { return {reinterpret_cast<const char*>(bytes), size}; }
};

extern const PagePart kPageParts[];
extern const std::size_t kPagePartCount;

/// Null where the program has none of this name.
[[nodiscard]] const PagePart* find_page_part(std::string_view name) noexcept;

}  // namespace crankloop::program
