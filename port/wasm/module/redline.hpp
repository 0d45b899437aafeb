// The redline's search of a page: page_redline() and page_redline_step() of module.h.
//
// What belongs here: what it answers. What does not: the search (redline_search.hpp of the program).
#pragma once

#include <memory>
#include <string>

#include "crankloop/commands/redline/redline_search.hpp"
#include "json.hpp"

namespace crankloop::page {

/// One search after another. Both throw InputError, and leave what was before.
class RedlineSearch {
 public:
  /// 0 rpm: the limit that the program has for it.
  void begin(Json& json, const std::shared_ptr<const program::EngineFile>& file, const std::string& train, int from_rpm,
             int to_rpm);

  /// Runs one speed; where all have been run, answers the onsets.
  void step(Json& json);

 private:
  std::shared_ptr<const program::EngineFile> file_;  ///< the valve points to it
  std::unique_ptr<program::LoneValve> valve_;        ///< the search points to it
  std::unique_ptr<program::SpeedSearch> search_;
  program::SpeedRange range_{0, 0, 1};
  int speeds_run_ = 0;
};

}  // namespace crankloop::page
