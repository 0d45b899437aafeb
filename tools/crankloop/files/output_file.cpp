#include "output_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

#include "error.hpp"
#include "files_in_use.hpp"

namespace crankloop::program {
namespace {

constexpr std::size_t kBufferBytes = 65536;
constexpr int kMaxNames = 100;

/// Resolves symbolic links, also those to a missing file: renaming onto a link would replace the link, not the file. A
/// target without a path (/dev/stdout of a pipe) keeps its name; a loop of links is left to stat(), which refuses it.
std::string behind_links(const std::string& name) {
  constexpr int kMaxLinks = 40;  // the kernel's own limit
  std::error_code error;
  std::filesystem::path path = std::filesystem::canonical(name, error);
  if (!error) return path.string();
  path = name;
  if (std::filesystem::exists(path, error)) return name;
  for (int i = 0; i < kMaxLinks && std::filesystem::is_symlink(path, error); ++i)
    path = path.parent_path() / std::filesystem::read_symlink(path, error);
  return path.string();
}

// ---- unfinished files and signals -----------------------------------------------------------------------------------

constexpr std::string_view kUnfinished = ".unfinished-";

/// Paths that a signal handler may read at any moment: a slot's path changes only while the slot is not armed. A longer
/// path, or a file without a free slot, is left to the next run.
struct UnfinishedPlace {
  std::atomic<bool> taken{false};
  std::atomic<bool> armed{false};
  std::array<char, PATH_MAX> path{};
};
std::array<UnfinishedPlace, 8> unfinished_places;
static_assert(std::atomic<bool>::is_always_lock_free, "else no handler may touch it");

void arm(const std::string& path) {
  if (path.size() >= PATH_MAX) return;
  for (UnfinishedPlace& place : unfinished_places) {
    if (place.taken.exchange(true)) continue;
    std::copy_n(path.c_str(), path.size() + 1, place.path.data());
    place.armed = true;
    return;
  }
}

void disarm(const std::string& path) {
  for (UnfinishedPlace& place : unfinished_places) {
    if (!place.armed || path != place.path.data()) continue;
    place.armed = false;
    place.taken = false;
    return;
  }
}

/// Blocks signals during its lifetime, so that creating a file and arming its slot are atomic.
class SignalsHeld {
 public:
  SignalsHeld() noexcept {
    sigset_t all;
    ::sigfillset(&all);
    ::sigprocmask(SIG_BLOCK, &all, &before_);
  }
  SignalsHeld(const SignalsHeld&) = delete;
  SignalsHeld& operator=(const SignalsHeld&) = delete;
  ~SignalsHeld() { ::sigprocmask(SIG_SETMASK, &before_, nullptr); }

 private:
  sigset_t before_{};
};

/// Calls only functions that POSIX lists as async-signal-safe. Then raises the signal again with its default action.
extern "C" void remove_unfinished_and_end(int signal_number) {
  for (const UnfinishedPlace& place : unfinished_places) {
    if (place.armed) ::unlink(place.path.data());
  }
  std::signal(signal_number, SIG_DFL);
  std::raise(signal_number);
}

// ---- files left by killed runs --------------------------------------------------------------------------------------

/// What the temporary names of a file begin with: its own name, as much of it as leaves room for the rest.
std::string unfinished_start(const std::filesystem::path& path) {
  constexpr std::size_t kNumbers = sizeof "4294967295-99" - 1;
  constexpr std::size_t kRoom = NAME_MAX - kUnfinished.size() - kNumbers;
  std::string name = path.filename().string();
  if (name.size() > kRoom) {
    std::size_t end = kRoom;
    while (end > 0 && (name[end] & 0xC0) == 0x80) --end;  // not within a character of UTF-8
    name.resize(end);
  }
  return name + std::string(kUnfinished);
}

/// Whether `name` is `start` and two numbers with a dash between, as create_unfinished() makes it.
bool is_unfinished(std::string_view name, std::string_view start) {
  if (name.substr(0, start.size()) != start) return false;
  const std::string_view numbers = name.substr(start.size());
  const std::size_t dash = numbers.find('-');
  const auto is_number = [](std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
  };
  return dash != std::string_view::npos && is_number(numbers.substr(0, dash)) && is_number(numbers.substr(dash + 1));
}

/// Removes a left-over file, unless its writer is still running and holds its lock.
void remove_if_left_over(const std::string& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (file < 0) return;
  struct stat found {};
  if (::fstat(file, &found) == 0 && S_ISREG(found.st_mode) && ::flock(file, LOCK_EX | LOCK_NB) == 0)
    ::unlink(path.c_str());
  ::close(file);
}

void remove_left_overs(const std::string& path) {
  const std::filesystem::path whole(path);
  const std::string start = unfinished_start(whole);
  const std::filesystem::path folder = whole.has_parent_path() ? whole.parent_path() : std::filesystem::path(".");
  std::error_code error;  // a folder that cannot be listed may still be writable
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (is_unfinished(entry->path().filename().string(), start)) remove_if_left_over(entry->path().string());
  }
}

/// Locks a new file. False if another run has taken it for a left-over just before, and removes it.
bool claim(int file) {
  if (::flock(file, LOCK_EX | LOCK_NB) != 0)
    return errno != EWOULDBLOCK;  // without locks in the file system, left-overs are not removed either
  struct stat found {};
  return ::fstat(file, &found) == 0 && found.st_nlink > 0;
}

}  // namespace

void Output::remove_unfinished_at_signals() {
  for (const int number : {SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGXCPU}) {
    struct sigaction before {};
    if (::sigaction(number, nullptr, &before) == 0 && before.sa_handler != SIG_IGN)
      std::signal(number, remove_unfinished_and_end);
  }
}

Output::Output(const std::string& path) {
  const bool standard = is_standard_output(path);
  if (standard) claim_output(path);
  if (path.empty() || standard) {
    file_ = STDOUT_FILENO;
    return;
  }
  path_ = behind_links(path);
  claim_output(path_);
  struct stat old {};
  const bool exists = ::stat(path_.c_str(), &old) == 0;
  if (!exists && errno != ENOENT) fail("cannot be created");
  if (exists && !S_ISREG(old.st_mode)) {
    file_ = ::open(path_.c_str(), O_WRONLY | O_CLOEXEC);
    if (file_ < 0) fail("cannot be written");
    return;
  }
  if (exists && ::access(path_.c_str(), W_OK) != 0) fail("cannot be written");
  remove_left_overs(path_);
  create_unfinished();
  if (exists && ::fchmod(file_, old.st_mode & 07777) != 0) fail("cannot be given its permissions");
}

void Output::create_unfinished() {
  const std::string start = std::filesystem::path(path_).replace_filename(unfinished_start(path_)).string();
  // More than one attempt only if several outputs go to one path, or the name is taken.
  for (int attempt = 0; attempt < kMaxNames; ++attempt) {
    const SignalsHeld held;
    temporary_ = start + std::to_string(::getpid()) + "-" + std::to_string(attempt);
    file_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file_ >= 0 && claim(file_)) return arm(temporary_);
    temporary_.clear();
    if (file_ < 0 && errno != EEXIST) break;
    if (file_ >= 0) ::close(std::exchange(file_, -1));
  }
  fail("cannot be created");
}

void Output::discard_unfinished() {
  if (temporary_.empty()) return;
  ::unlink(temporary_.c_str());
  disarm(temporary_);
  temporary_.clear();
}

Output::Output(Output&& other) noexcept
    : path_{std::move(other.path_)},
      temporary_{std::exchange(other.temporary_, {})},
      file_{std::exchange(other.file_, -1)},
      buffer_{std::move(other.buffer_)} {}

Output::~Output() {
  discard_unfinished();
  if (file_ >= 0 && !is_standard()) ::close(file_);
}

bool Output::is_standard() const noexcept { return file_ == STDOUT_FILENO; }

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
  if (!temporary_.empty()) demand_unread(path_);
  flush();
  const int locked =
      temporary_.empty() ? -1 : ::fcntl(file_, F_DUPFD_CLOEXEC, 0);  // the lock lasts until the file has its name
  const bool closed = is_standard() || ::close(std::exchange(file_, -1)) == 0;
  const bool named = closed && (temporary_.empty() || std::rename(temporary_.c_str(), path_.c_str()) == 0);
  if (!named) fail(closed ? "cannot be created" : "cannot be written");
  disarm(temporary_);
  temporary_.clear();
  if (locked >= 0) ::close(locked);
}

void Output::fail(const char* what) {
  const int error = errno;
  discard_unfinished();
  if (path_.empty() && error == EPIPE) throw ReaderGone();
  throw OutputError((path_.empty() ? "standard output" : path_) + " " + what + ": " + std::strerror(error));
}

void print(std::string_view text) {
  Output out = Output::standard();
  out.write(text);
  out.finish();
}

}  // namespace crankloop::program
