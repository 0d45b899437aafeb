// Exception types for the ways in which a command ends early.
//
// What belongs here: message and exit status. What does not: wording (it is where the error is found).
#pragma once

#include <stdexcept>
#include <string>

namespace crankloop::program {

enum ExitStatus : int {
  kSuccess = 0,
  kFailure = 1,   ///< an error of the program or the machine: full disk, closed pipe, a defect
  kBadInput = 2,  ///< an error of the user: an option, an engine file, a table
};

/// Bad input. The message is a line "FILE:LINE: what is wrong, what is allowed", of an engine file up to 20.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& message) : std::runtime_error(message) {}
  InputError(const std::string& path, int line, const std::string& message)
      : std::runtime_error(path + ":" + std::to_string(line) + ": " + message) {}
};

/// A bad command line; main() adds the command's usage line.
class UsageError : public InputError {
 public:
  using InputError::InputError;
};

/// Output that could not be written.
class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The reader of the output has closed it (`| head`): ends without a message.
class ReaderGone : public OutputError {
 public:
  ReaderGone() : OutputError("standard output was closed by its reader") {}
};

}  // namespace crankloop::program
