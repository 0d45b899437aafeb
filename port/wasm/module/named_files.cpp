#include "named_files.hpp"

#include <map>
#include <utility>

#include "crankloop/files/text_file.hpp"

namespace crankloop::page {
namespace {

std::map<std::string, std::string>& files() {
  static std::map<std::string, std::string> all;
  return all;
}

}  // namespace

void put_file(std::string name, std::string bytes) { files()[std::move(name)] = std::move(bytes); }
void forget_files() { files().clear(); }

}  // namespace crankloop::page

namespace crankloop::program {

FileBytes read_file(const std::string& path, std::size_t most_bytes) {
  const auto found = page::files().find(path);
  if (found == page::files().end()) return {"", "cannot be read: No such file or directory"};
  if (found->second.size() > most_bytes)
    return {"", "is too large; at most " + std::to_string(most_bytes >> 20) + " MiB are allowed"};
  return {found->second, ""};
}

std::string folder_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? "" : path.substr(0, slash);
}

std::string in_folder(const std::string& folder, const std::string& name) {
  return folder.empty() || name.substr(0, 1) == "/" ? name : folder + "/" + name;
}

}  // namespace crankloop::program
