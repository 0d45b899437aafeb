// A text file as lines, or one clear refusal: too large, binary, unreadable.
//
// What belongs here: bytes and line ends. What does not: what the lines mean (ini_text.hpp, table_file.hpp).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace crankloop::program {

/// The bytes of a file, or why it cannot be read.
struct FileBytes {
  std::string bytes;
  std::string problem;  ///< "cannot be read: No such file or directory"; empty when all is well

  [[nodiscard]] bool ok() const noexcept { return problem.empty(); }
};

/// `most_bytes` is a whole number of MiB. A file that is larger is a problem, an empty one is not. Only a regular file
/// is read: pipes and devices may be endless, block, or have side effects when they are read.
[[nodiscard]] FileBytes read_file(const std::string& path, std::size_t most_bytes);

/// Calls `observer` with the path and the descriptor of every file that read_file() opens from now on, before it reads
/// the first byte; what the observer throws, read_file() throws. Null: none, as before the first call. Not on Windows.
/// Call it before other threads are started.
using FileReadObserver = void (*)(const std::string& path, int descriptor);
void observe_files_read(FileReadObserver observer);

/// A file's name for a message: every control character, and every byte that is not UTF-8, as \xNN.
[[nodiscard]] std::string printable(const std::string& name);

/// Paths here are UTF-8 on every system. The folder of a file, and the path of a file that another file in the folder
/// names.
[[nodiscard]] std::string folder_of(const std::string& path);
[[nodiscard]] std::string in_folder(const std::string& folder, const std::string& name);

/// Lines without their ends. LF and CRLF end a line, the last line needs no end, a UTF-8 byte order mark is skipped.
///
/// Throws InputError, "not a text file", at the first line with a control character other than tab, or with bytes that
/// are not UTF-8: so no message and no report can carry control codes from a file to a terminal or a browser.
[[nodiscard]] std::vector<std::string> split_lines(const std::string& bytes, const std::string& path);

}  // namespace crankloop::program
