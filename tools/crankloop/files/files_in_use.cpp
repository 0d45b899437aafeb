#include "files_in_use.hpp"

#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <mutex>
#include <optional>
#include <vector>

#include "error.hpp"
#include "text_file.hpp"

namespace crankloop::program {
namespace {

/// Identity of a file, pipe or device, independent of its names.
struct FileIdentity {
  dev_t device;
  ino_t number;  ///< 0: the device itself

  friend bool operator==(const FileIdentity& a, const FileIdentity& b) {
    return a.device == b.device && a.number == b.number;
  }
};

using MaybeFile = std::optional<FileIdentity>;

MaybeFile identity_of(const struct stat& found) {
  return S_ISREG(found.st_mode) ? MaybeFile{{found.st_dev, found.st_ino}} : std::nullopt;
}
MaybeFile file_at(const std::string& path) {
  struct stat found {};
  return ::stat(path.c_str(), &found) == 0 ? identity_of(found) : std::nullopt;
}
MaybeFile open_file(int descriptor) {
  struct stat found {};
  return ::fstat(descriptor, &found) == 0 ? identity_of(found) : std::nullopt;
}

/// Identity of a pipe, socket or device; none of /dev/null and its like, where nothing can be mixed.
MaybeFile stream_of(const struct stat& found) {
  constexpr unsigned kMemoryDevices = 1;
  if (S_ISFIFO(found.st_mode) || S_ISSOCK(found.st_mode)) return {{found.st_dev, found.st_ino}};
  const bool device = S_ISBLK(found.st_mode) || (S_ISCHR(found.st_mode) && major(found.st_rdev) != kMemoryDevices);
  return device ? MaybeFile{{found.st_rdev, 0}} : std::nullopt;
}
MaybeFile stream_at(const std::string& path) {
  struct stat found {};
  return ::stat(path.c_str(), &found) == 0 ? stream_of(found) : std::nullopt;
}

/// Absolute path of a file that does not exist yet.
std::string place_of(const std::string& path) {
  if (is_standard_output(path)) return "-";
  std::error_code error;
  const std::filesystem::path whole = std::filesystem::absolute(path, error);
  const std::filesystem::path folder = std::filesystem::weakly_canonical(whole.parent_path(), error);
  return (folder / whole.filename()).string();
}

struct Used {
  std::string path;  ///< as the user knows it
  std::string place;
  MaybeFile file;
};

bool watching = false;
std::mutex reading;  // files are read by several threads
std::vector<Used> files_read;
std::vector<Used> outputs;

/// The stream of this process that goes to a file, in words; null for none.
const char* stream_into(const MaybeFile& file) {
  if (file && file == open_file(STDOUT_FILENO)) return "standard output";
  return file && file == open_file(STDERR_FILENO) ? "stderr" : nullptr;
}

void note_file_read(const std::string& path, int descriptor) {
  const MaybeFile file = open_file(descriptor);
  if (const char* stream = stream_into(file)) {
    throw InputError(
        path + ": this command reads it, and " + stream +
        " goes there; if that was by >, the shell has emptied the file already; send the output elsewhere");
  }
  const std::lock_guard<std::mutex> lock(reading);
  for (const Used& other : files_read) {
    if (other.path == path && other.file == file) return;  // by each point of a study
  }
  files_read.push_back({path, "", file});
}

}  // namespace

void watch_files_in_use() {
  watching = true;
  observe_files_read(note_file_read);
}

void demand_unread(const std::string& path) {
  const MaybeFile file = file_at(path);
  if (!watching || !file) return;
  for (const Used& input : files_read) {
    if (input.file == file) {
      const std::string other = input.path == path ? "" : "is the same file as " + input.path + "; ";
      throw InputError(path + ": " + other + "this command reads it; write to another file");
    }
  }
}

bool is_standard_output(const std::string& path) {
  if (path == "-") return true;
  struct stat standard {};
  const MaybeFile stream = stream_at(path);
  return stream && ::fstat(STDOUT_FILENO, &standard) == 0 && stream == stream_of(standard);
}

void claim_output(const std::string& path) {
  if (!watching) return;
  Used output{path, place_of(path), std::nullopt};
  if (output.place != "-") {
    output.file = file_at(path);
    if (!output.file) output.file = stream_at(path);
    std::error_code error;                                             // a loop of links is not a device either
    if (!output.file && std::filesystem::exists(path, error)) return;  // /dev/null
    demand_unread(path);
    if (const char* stream = stream_into(output.file))
      throw InputError(path + ": " + stream + " goes there too; write to another file");
  }
  for (const Used& other : outputs) {
    if (other.place == output.place || (output.file && output.file == other.file))
      throw InputError(path + ": named for two outputs, here and as " + other.path + "; each needs a file of its own");
  }
  outputs.push_back(std::move(output));
}

}  // namespace crankloop::program
