// Output to standard output, or to a file that appears complete or not at all.
//
// What belongs here: bytes and their errors. What does not: their format (csv.hpp).
#pragma once

#include <string>
#include <string_view>

namespace crankloop::program {

/// Buffered output. A file is written under a temporary name in the same folder and renamed by finish(), so that an
/// error leaves the old file or none, never a partial one. Devices and pipes are written directly. A symbolic link
/// stays: its target is replaced or created.
///
/// A file that the command reads, or that is another of its outputs, is refused by InputError (files_in_use.hpp).
///
/// The temporary name is the path, a long name cut, with .unfinished-PID-N appended; its file is locked (flock) while
/// its writer runs. The next writer to the same path removes a file that a killed writer left.
///
/// Every other failure throws OutputError; unfinished output is discarded.
class Output {
 public:
  /// "" and "-" are standard output, and so is another name of its pipe or terminal.
  explicit Output(const std::string& path);
  static Output standard() { return Output(""); }

  /// Installs handlers: a signal that ends the program removes its unfinished files first. Ignored signals stay ignored
  /// (nohup).
  static void remove_unfinished_at_signals();

  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;
  Output(Output&& other) noexcept;
  Output& operator=(Output&&) = delete;
  ~Output();

  [[nodiscard]] bool is_standard() const noexcept;

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

/// Writes a whole text to standard output.
void print(std::string_view text);

}  // namespace crankloop::program
