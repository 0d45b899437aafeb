// The page's script: read-outs under the pointer, curves that a click on their names hides.
#pragma once

#include <string_view>

namespace crankloop::report {

/// What stands between <script> and </script>.
[[nodiscard]] std::string_view read_out_script();

/// Its SHA-256 in base64: the page's content security policy allows no other script.
inline constexpr const char* kReadOutHash = "zPfch7zSTPj0ROh/n+1y4PhJWIdbiJX7GGB5h5OmHpc=";

}  // namespace crankloop::report
