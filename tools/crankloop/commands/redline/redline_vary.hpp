// What `redline --vary` repeats its sweep with: a short name times factors, or any key of the engine file.
//
// What belongs here: the trains, and how they are told apart. What does not: the sweep (redline_search.hpp).
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "../../loops/valve_loop.hpp"

namespace crankloop::program {

/// One train of the comparison.
struct VariedTrain {
  std::shared_ptr<const LoneValve> valve;
  double at;          ///< factor, value of the key, or the place of a word
  std::string value;  ///< "0.85", "0.05", "a.csv"
  bool as_given;      ///< as the file has it
};

struct VariedTrains {
  std::string option;  ///< of --vary
  std::string title;   ///< "Spring rate", "clearance of [rocker intake]"
  std::string keys;    ///< that are multiplied; of a key its name
  std::string unit;    ///< in words
  bool are_factors = true;
  bool are_words = false;
  std::vector<VariedTrain> trains{};  ///< one of them as given
  std::deque<EngineFile> files{};     ///< of the trains
};

/// Throws UsageError for what is neither a short name nor SECTION.KEY=VALUES, InputError for a value that the file
/// cannot have and where there is nothing to vary.
[[nodiscard]] VariedTrains varied_trains(const LoneValve& valve, const std::string& option);

}  // namespace crankloop::program
