// What an engine file's engine is, as JSON for drawing and sliders: page_facts() and page_keys() of module.h.
#pragma once

#include <string>

#include "crankloop/engine_file/engine_file.hpp"

namespace crankloop::page {

[[nodiscard]] std::string facts_of(const program::EngineFile& file);
[[nodiscard]] std::string keys_of(const program::EngineFile& file);

}  // namespace crankloop::page
