// A ZIP archive without compression: the same files give the same bytes, on any machine and day.
//
// What belongs here: the archive's format. What does not: the choice of files.
#pragma once

#include <string>
#include <vector>

namespace crankloop::program {

struct ZipEntry {
  std::string name;  ///< "binaries/linux64/engine.so"
  std::string bytes;
};

/// The archive, entries in their order: method 0, no data descriptors, no extra fields, no user, no mode, every date
/// 1980-01-01. Throws InputError for a name that is not ASCII, or for more than the format holds: 65535 files, 4 GiB.
[[nodiscard]] std::string stored_zip(const std::vector<ZipEntry>& entries);

/// modelDescription.xml first, where importers look, all others sorted.
void sort_as_fmu(std::vector<ZipEntry>& entries);

/// Every file below a folder, in no order. Throws InputError for a folder that cannot be read, and for an entry that is
/// neither file nor folder.
[[nodiscard]] std::vector<ZipEntry> files_below(const std::string& folder);

}  // namespace crankloop::program
