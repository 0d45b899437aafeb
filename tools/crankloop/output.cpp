#include "output.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

#include "error.hpp"
#include "number.hpp"

namespace crankloop::program {
namespace {

constexpr std::size_t kBufferBytes = 65536;
constexpr int kMostNames = 100;

/// Where a name leads: renaming onto a symbolic link would replace the link, not the file.
std::string behind_links(const std::string& path) {
  std::error_code error;
  const std::filesystem::path real = std::filesystem::canonical(path, error);
  return error ? path : real.string();
}

}  // namespace

Output::Output(const std::string& path) {
  if (path.empty() || path == "-") {
    file_ = STDOUT_FILENO;
    return;
  }
  path_ = behind_links(path);
  struct stat old {};
  const bool exists = ::stat(path_.c_str(), &old) == 0;
  if (exists && !S_ISREG(old.st_mode)) {
    file_ = ::open(path_.c_str(), O_WRONLY | O_CLOEXEC);
    if (file_ < 0) fail("cannot be written");
    return;
  }
  if (exists && ::access(path_.c_str(), W_OK) != 0) fail("cannot be written");
  for (int attempt = 0; attempt < kMostNames && file_ < 0;
       ++attempt) {  // more than one only where a killed run left its file behind
    temporary_ = path_ + ".unfinished-" + std::to_string(::getpid()) + "-" + std::to_string(attempt);
    file_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file_ < 0 && errno != EEXIST) break;
  }
  if (file_ < 0) {
    temporary_.clear();
    fail("cannot be created");
  }
  if (exists && ::fchmod(file_, old.st_mode & 07777) != 0) fail("cannot be given its permissions");
}

Output::Output(Output&& other) noexcept
    : path_{std::move(other.path_)},
      temporary_{std::exchange(other.temporary_, {})},
      file_{std::exchange(other.file_, -1)},
      buffer_{std::move(other.buffer_)} {}

Output::~Output() {
  if (file_ >= 0 && file_ != STDOUT_FILENO) ::close(file_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void Output::write(std::string_view text) {
  buffer_ += text;
  if (buffer_.size() >= kBufferBytes) flush();
}

void Output::flush() {
  std::string_view left = buffer_;
  while (!left.empty()) {
    const ssize_t count = ::write(file_, left.data(), left.size());
    if (count >= 0) {
      left.remove_prefix(static_cast<std::size_t>(count));
    } else if (errno != EINTR) {
      fail("cannot be written");
    }
  }
  buffer_.clear();
}

void Output::finish() {
  flush();
  if (file_ != STDOUT_FILENO) {
    const int file = std::exchange(file_, -1);
    if (::close(file) != 0) fail("cannot be written");
  }
  if (temporary_.empty()) return;
  if (std::rename(temporary_.c_str(), path_.c_str()) != 0) fail("cannot be created");
  temporary_.clear();
}

void Output::fail(const char* what) {
  const int error = errno;
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  temporary_.clear();
  if (path_.empty() && error == EPIPE) throw ReaderGone();
  throw OutputError((path_.empty() ? "standard output" : path_) + " " + what + ": " + std::strerror(error));
}

void tell(const std::string& text, bool output_taken) {
  if (output_taken) {
    std::fputs(text.c_str(), stderr);
    return;
  }
  Output out = Output::standard();
  out.write(text);
  out.finish();
}

void write_summary(Output& out, std::string_view name, std::string_view text) {
  out.write(name);
  out.write(" = ");
  out.write(text);
  out.write("\n");
}

void write_summary(Output& out, std::string_view name, double value, std::string_view unit) {
  write_summary(out, name, unit.empty() ? significant(value) : significant(value) + " " + std::string(unit));
}

void write_summary(Output& out, std::string_view name, float value, std::string_view unit) {
  write_summary(out, name, unit.empty() ? significant(value) : significant(value) + " " + std::string(unit));
}

}  // namespace crankloop::program
