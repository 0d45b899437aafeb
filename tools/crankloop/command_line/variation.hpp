// What a study varies: a key of the engine file or an option of a command, and its values.
//
//     cam.intake.max_lift_mm=6:7:11    FROM:TO:N, evenly spaced
//     cam.file=a.csv,b.csv             a list; of keys that are lists themselves with / between: exponents=2,8/2,10
//     rpm=3000:9000:25                 an option, here --rpm
//
// What belongs here: reading that. What does not: what is computed with the values.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "../engine_file/engine_file.hpp"
#include "arguments.hpp"

namespace crankloop::program {

inline constexpr int kMaxValues = 100000;

/// A key, or else an option.
struct Target {
  std::optional<KeyPlace> key{};
  const Option* option = nullptr;

  [[nodiscard]] std::string name() const;   ///< "cam.intake.max_lift_mm", "rpm"
  [[nodiscard]] std::string title() const;  ///< "max lift of [cam intake]", "--rpm"
  [[nodiscard]] std::string unit() const;   ///< in words; "" where it has none, or an option's
};

struct Variation {
  Target target{};
  std::vector<std::string> values{};
  std::vector<double> numbers{};       ///< the same; empty where one of them is a word
  std::string own{};                   ///< what it is without --vary; empty where that is unknown
  std::optional<double> own_number{};  ///< of numbers

  [[nodiscard]] bool is_of_words() const noexcept { return numbers.empty(); }
};

/// NAME=VALUES, as above. Names without a point are those of options; of `options`, without the dashes. Throws
/// UsageError, and InputError for a key that the file cannot have.
[[nodiscard]] Variation parse_variation(const std::string& text, const EngineFile& file,
                                        const std::vector<const Option*>& options);

/// NAME=VALUE: the value stands for one.
struct Constant {
  Target target;
  std::string value;
};
[[nodiscard]] Constant parse_constant(const std::string& text, const EngineFile& file,
                                      const std::vector<const Option*>& options);

/// Refuses keys that the file does not use with these settings, as a lift of a cam whose source is a table.
void require_used(const EngineFile& file, const KeyPlace& place);

}  // namespace crankloop::program
