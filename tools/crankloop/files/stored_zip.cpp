#include "stored_zip.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <utility>

#include <crankloop/tick/state/saved_bytes.hpp>

#include "error.hpp"
#include "text_file.hpp"

namespace crankloop::program {
namespace {

constexpr std::size_t kMaxEntries = 0xFFFF;
constexpr std::size_t kMaxBytes = 0xFFFF'FFFF;
constexpr std::size_t kMaxFileBytes = std::size_t{1} << 30;

constexpr std::uint32_t kLocalHeader = 0x04034B50;
constexpr std::uint32_t kCentralHeader = 0x02014B50;
constexpr std::uint32_t kEndOfCentral = 0x06054B50;
constexpr std::uint32_t kVersion = 10;        // 1.0: nothing but stored files
constexpr std::uint32_t kFirstDate = 0x0021;  // 1980-01-01, the earliest possible; the time is 0

void put(std::string& to, std::uint32_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) to += static_cast<char>(value >> (8 * i) & 0xFFu);
}

/// Common part of a file's header and its entry in the directory.
void put_common(std::string& to, const ZipEntry& entry) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(entry.bytes.data());
  const auto size = static_cast<std::uint32_t>(entry.bytes.size());
  put(to, kVersion, 2);
  put(to, 0, 2);  // flags
  put(to, 0, 2);  // method: stored
  put(to, 0, 2);  // time
  put(to, kFirstDate, 2);
  put(to, detail::crc32_of(bytes, entry.bytes.size()), 4);
  put(to, size, 4);
  put(to, size, 4);
  put(to, static_cast<std::uint32_t>(entry.name.size()), 2);
  put(to, 0, 2);  // extra field
}

}  // namespace

std::string stored_zip(const std::vector<ZipEntry>& entries) {
  if (entries.size() > kMaxEntries) throw InputError("an archive holds at most 65535 files");
  std::string archive;
  std::string directory;
  for (const ZipEntry& entry : entries) {
    const auto is_ascii = [](char c) { return c >= ' ' && c <= '~'; };
    if (!std::all_of(entry.name.begin(), entry.name.end(), is_ascii) || entry.name.size() > kMaxEntries)
      throw InputError(printable(entry.name) + ": names in an archive are ASCII");
    if (archive.size() + entry.bytes.size() + directory.size() > kMaxBytes - 4 * kMaxEntries)
      throw InputError(printable(entry.name) + ": an archive holds at most 4 GiB");
    put(directory, kCentralHeader, 4);
    put(directory, kVersion, 2);  // version and system that made it: none in particular
    put_common(directory, entry);
    put(directory, 0, 2);  // comment
    put(directory, 0, 2);  // disk
    put(directory, 0, 2);  // internal attributes
    put(directory, 0, 4);  // external attributes
    put(directory, static_cast<std::uint32_t>(archive.size()), 4);
    directory += entry.name;
    put(archive, kLocalHeader, 4);
    put_common(archive, entry);
    archive += entry.name;
    archive += entry.bytes;
  }
  const auto at = static_cast<std::uint32_t>(archive.size());
  const auto count = static_cast<std::uint32_t>(entries.size());
  archive += directory;
  put(archive, kEndOfCentral, 4);
  put(archive, 0, 4);  // disks
  put(archive, count, 2);
  put(archive, count, 2);
  put(archive, static_cast<std::uint32_t>(directory.size()), 4);
  put(archive, at, 4);
  put(archive, 0, 2);  // comment
  return archive;
}

void sort_as_fmu(std::vector<ZipEntry>& entries) {
  const auto place = [](const ZipEntry& entry) {
    return std::pair<bool, const std::string&>(entry.name != "modelDescription.xml", entry.name);
  };
  std::sort(entries.begin(), entries.end(), [&](const ZipEntry& a, const ZipEntry& b) { return place(a) < place(b); });
}

std::vector<ZipEntry> files_below(const std::string& folder) {
  namespace fs = std::filesystem;
  std::vector<ZipEntry> entries;
  try {
    for (const auto& item : fs::recursive_directory_iterator(folder)) {
      if (item.is_directory()) continue;
      const std::string path = item.path().string();
      const FileBytes file = read_file(path, kMaxFileBytes);
      if (!file.ok()) throw InputError(printable(path) + ": " + file.problem);
      entries.push_back({fs::relative(item.path(), folder).generic_string(), file.bytes});
    }
  } catch (const fs::filesystem_error& error) {
    throw InputError(folder + ": cannot be read: " + error.code().message());
  }
  return entries;
}

}  // namespace crankloop::program
