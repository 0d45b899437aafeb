// The engine file that a command names: read, and its warnings told.
#pragma once

#include <string>
#include <vector>

#include "../engine_file/engine_file.hpp"
#include "arguments.hpp"

namespace crankloop::program {

/// Tells them on stderr and returns them, for a report; with --no-warnings there are none.
std::vector<std::string> tell_warnings(const Arguments& arguments, std::vector<std::string> warnings);

/// The engine of a command's file, its warnings printed, and kept on request; else as read_engine_file().
[[nodiscard]] EngineFile read_engine(const Arguments& arguments, const std::vector<std::string>& needed_sections,
                                     std::vector<std::string>* warnings = nullptr);

/// The same for a command that runs ready-made scenes: warns where they leave out what the file asks for.
[[nodiscard]] EngineFile read_engine_for_scenes(const Arguments& arguments,
                                                const std::vector<std::string>& needed_sections,
                                                std::vector<std::string>* warnings = nullptr);

}  // namespace crankloop::program
