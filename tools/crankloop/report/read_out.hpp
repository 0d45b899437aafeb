// The page's script: values under the pointer, and curves that can be hidden by a click on their names.
#pragma once

#include <string_view>

namespace crankloop::report {

/// The text between <script> and </script>.
[[nodiscard]] std::string_view read_out_script();

/// Its SHA-256 in base64: the page's content security policy allows no other script.
inline constexpr const char* kReadOutHash = "zPfch7zSTPj0ROh/n+1y4PhJWIdbiJX7GGB5h5OmHpc=";

}  // namespace crankloop::report
