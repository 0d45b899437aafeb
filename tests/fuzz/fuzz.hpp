// What fuzz targets share: bytes as numbers, a file to be read, and an end that the fuzzer sees.
//
// What belongs here: helpers. What does not: any target's promise (one file each beside this).
#pragma once

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace crankloop::fuzz {

/// Ends the process, so that the fuzzer keeps the input: a promise is broken.
inline void must(bool kept, const char* promise) {
  if (kept) return;
  std::fprintf(stderr, "broken promise: %s\n", promise);
  std::abort();
}

/// The fuzzer's bytes one after the other; zeros beyond their end.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : at_{data}, left_{size} {}

  [[nodiscard]] bool empty() const { return left_ == 0; }

  void fill(void* to, std::size_t size) {
    std::memset(to, 0, size);
    const std::size_t n = size < left_ ? size : left_;
    if (n > 0) std::memcpy(to, at_, n);
    at_ += n, left_ -= n;
  }
  template <class T>
  [[nodiscard]] T take() {
    T x;
    fill(&x, sizeof x);
    return x;
  }

  /// A number as it may stand in a definition: by its first byte as given, another one that is often near a limit, or
  /// any bits at all. `usual` is a good one.
  [[nodiscard]] double number(double usual) {
    const auto how = take<std::uint8_t>();
    if (how < 128) return usual;
    if (how < 224) {
      const double factors[] = {0, -0.0, -1, 1e-3, 0.1, 0.5, 0.9, 1.1, 2, 10, 1e3, 1e300};
      return usual * factors[how % (sizeof factors / sizeof factors[0])];
    }
    return take<double>();
  }

 private:
  const std::uint8_t* at_;
  std::size_t left_;
};

/// A file that holds what it is given last; removed at the end of the process.
class TextFile {
 public:
  explicit TextFile(const char* name) : path_{"fuzz-XXXXXX"} {
    const char* const folder = std::getenv("TMPDIR");
    path_ = std::string(folder != nullptr ? folder : "/tmp") + "/" + path_;
    must(mkdtemp(path_.data()) != nullptr, "a temporary folder can be made");
    folder_ = path_;
    path_ += std::string("/") + name;
  }
  TextFile(const TextFile&) = delete;
  TextFile& operator=(const TextFile&) = delete;
  ~TextFile() {
    std::remove(path_.c_str());
    rmdir(folder_.c_str());
  }

  void write(const void* data, std::size_t size) const {
    std::FILE* const file = std::fopen(path_.c_str(), "wb");
    must(file != nullptr, "the temporary file can be written");
    std::fwrite(data, 1, size, file);
    std::fclose(file);
  }
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
  std::string folder_;
};

}  // namespace crankloop::fuzz
