// Bytes as a page wants them: base64, and the digest by which its policy names a script.
//
// What belongs here: those two codes. What does not: what they are of.
#pragma once

#include <string>
#include <string_view>

namespace crankloop::program {

/// RFC 4648, with padding.
[[nodiscard]] std::string base64(std::string_view bytes);

/// SHA-256 (FIPS 180-4), 32 bytes.
[[nodiscard]] std::string sha256(std::string_view bytes);

}  // namespace crankloop::program
