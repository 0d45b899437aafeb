// `--inputs IN.csv` of commands whose crank is free.
//
// What belongs here: the option, and what of the file an engine cannot follow. What does not: the file's format
// (input_schedule.hpp).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "../command_line/arguments.hpp"
#include "../engine_file/engine_file.hpp"
#include "input_schedule.hpp"

namespace crankloop::program {

inline constexpr Option kInputs =
    text("--inputs", "IN.csv",
         "CSV file time_s,NAME,... with inputs of the engine over time, by the names of FMU variables");

/// The file of --inputs, where it is given. Throws InputError, as InputSchedule does, and where the engine has nothing
/// that an input acts on: a starter, a diagram to scale.
[[nodiscard]] std::optional<InputSchedule> read_inputs(const Arguments& arguments, const EngineFile& engine,
                                                       const std::vector<SceneInput>& inputs);

/// Warns about columns that another input keeps from having an effect. `excess_air_ratio`: where no column sets it.
[[nodiscard]] std::vector<std::string> warnings_about_inputs(const InputSchedule& schedule, double excess_air_ratio);

}  // namespace crankloop::program
