// Where results go: standard output, or a file that appears complete or not at all.
//
// What belongs here: bytes and their errors. What does not: their format (csv.hpp).
#pragma once

#include <string>
#include <string_view>

namespace crankloop::program {

/// Buffered output. A file is written beside its place under another name and renamed by finish(), so that an error on
/// the way leaves the old file, or none, but never half of one. What is no file (/dev/null, a pipe) is written to
/// directly. A symbolic link stays: the file that it names is replaced, or made where there is none.
///
/// A file that the command reads, or that is another of its outputs, is refused by InputError (files_in_use.hpp).
///
/// The other name is the path's with .unfinished-PID-N behind it, its file locked (flock) as long as its writer lives.
/// What a writer left that was killed is removed by the next one to the same path.
///
/// Every other failure throws OutputError; what was not finished is discarded.
class Output {
 public:
  /// "" and "-" are standard output.
  explicit Output(const std::string& path);
  static Output standard() { return Output(""); }

  /// From now on a signal that ends the program removes its unfinished files first. Signals that are ignored stay so
  /// (nohup).
  static void remove_unfinished_at_signals();

  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;
  Output(Output&& other) noexcept;
  Output& operator=(Output&&) = delete;
  ~Output();

  void write(std::string_view text);
  void finish();  ///< nothing may be written after it

 private:
  void create_unfinished();
  void discard_unfinished();
  void flush();
  [[noreturn]] void fail(const char* what);

  std::string path_;       ///< empty: standard output
  std::string temporary_;  ///< empty: written directly
  int file_ = -1;
  std::string buffer_;
};

/// To standard output, whole.
void print(std::string_view text);

}  // namespace crankloop::program
