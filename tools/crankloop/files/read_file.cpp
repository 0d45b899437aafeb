// read_file(), the only part of reading engine files that needs more of the system than C++ has.
#include <cerrno>
#include <cstring>

#include "text_file.hpp"

#include <filesystem>

#if defined(_WIN32)
#include <cstdio>
#include <memory>
#include <system_error>
#else
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

namespace crankloop::program {
namespace {

std::string cannot_be_read(int error) { return std::string("cannot be read: ") + std::strerror(error); }
std::string is_too_large(std::size_t most_bytes) {
  return "is too large; at most " + std::to_string(most_bytes >> 20) + " MiB are allowed";
}
constexpr const char* kIsDirectory = "is a directory; a file is needed";
constexpr const char* kIsNotRegular = "is not a regular file; pipes and devices are not read";

#if defined(_WIN32)

/// Why a file cannot be read; "" if it can, or if only opening it shows.
std::string why_not_read(const std::filesystem::path& path) {
  std::error_code error;
  const auto type = std::filesystem::status(path, error).type();
  if (error || type == std::filesystem::file_type::not_found) return "";
  if (type == std::filesystem::file_type::directory) return kIsDirectory;
  return type == std::filesystem::file_type::regular ? "" : kIsNotRegular;
}

}  // namespace

FileBytes read_file(const std::string& path, std::size_t most_bytes) {
  const std::filesystem::path wide = std::filesystem::u8path(path);  // Windows' own narrow paths are of a code page
  FileBytes result;
  if (path.find('\0') != std::string::npos) result.problem = cannot_be_read(ENOENT);
  if (result.ok()) result.problem = why_not_read(wide);
  if (!result.ok()) return result;
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(::_wfopen(wide.c_str(), L"rb"), std::fclose);
  if (file == nullptr) {
    result.problem = cannot_be_read(errno);
    return result;
  }
  char chunk[16384];
  for (std::size_t count = 1; count > 0 && result.bytes.size() <= most_bytes;) {
    count = std::fread(chunk, 1, sizeof chunk, file.get());
    result.bytes.append(chunk, count);
  }
  if (std::ferror(file.get()) != 0) {
    result.problem = cannot_be_read(errno);
  } else if (result.bytes.size() > most_bytes) {
    result.problem = is_too_large(most_bytes);
  }
  return result;
}

#else

/// Why an open file cannot be read; "" if it can. Checks the open file, not its path, which may name another file by
/// then.
std::string why_not_read(int file) {
  struct stat found {};
  if (::fstat(file, &found) != 0) return cannot_be_read(errno);
  if (S_ISDIR(found.st_mode)) return kIsDirectory;
  return S_ISREG(found.st_mode) ? "" : kIsNotRegular;
}

FileReadObserver read_observer = nullptr;

/// Closed with the object.
class Descriptor {
 public:
  explicit Descriptor(int number) noexcept : number_{number} {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  operator int() const noexcept { return number_; }  // NOLINT: what the system calls take

 private:
  int number_;
};

}  // namespace

void observe_files_read(FileReadObserver observer) { read_observer = observer; }

FileBytes read_file(const std::string& path, std::size_t most_bytes) {
  FileBytes result;
  // Without O_NONBLOCK opening a FIFO would block until another process writes to it.
  constexpr int kFlags = O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY;
  const Descriptor file(path.find('\0') == std::string::npos ? ::open(path.c_str(), kFlags) : (errno = ENOENT, -1));
  int error = file < 0 ? errno : 0;
  if (file >= 0) result.problem = why_not_read(file);
  if (file >= 0 && result.ok() && read_observer != nullptr) read_observer(path, file);
  while (result.ok() && error == 0 && result.bytes.size() <= most_bytes) {
    char chunk[16384];
    const ssize_t count = ::read(file, chunk, sizeof chunk);
    if (count == 0) break;
    if (count > 0) result.bytes.append(chunk, static_cast<std::size_t>(count));
    if (count < 0 && errno != EINTR) error = errno;
  }
  if (error != 0) {
    result.problem = cannot_be_read(error);
  } else if (result.bytes.size() > most_bytes) {
    result.problem = is_too_large(most_bytes);
  }
  return result;
}

#endif

std::string folder_of(const std::string& path) { return std::filesystem::u8path(path).parent_path().u8string(); }

std::string in_folder(const std::string& folder, const std::string& name) {
  return (std::filesystem::u8path(folder) / std::filesystem::u8path(name)).u8string();
}

}  // namespace crankloop::program
