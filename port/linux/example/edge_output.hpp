// Where an edge player puts its edges: lines of a GPIO chip, or a file that keeps what was played and when.
//
// What belongs here: setting a line. What does not: when (edge_player.cpp).
#pragma once

#include <fcntl.h>
#include <linux/gpio.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace crankloop::port::example {

class OutputRefused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class EdgeOutput {
 public:
  EdgeOutput() = default;
  EdgeOutput(const EdgeOutput&) = delete;
  EdgeOutput& operator=(const EdgeOutput&) = delete;
  virtual ~EdgeOutput() = default;
  /// The line of a wheel goes to a level, now. A wheel without a line does nothing. False: the device refused.
  virtual bool set(std::uint32_t wheel, bool high) noexcept = 0;
  /// After the edge that was due then was set, `set_ns` by the clock. For outputs that keep books.
  virtual void note(std::uint32_t, bool, std::uint64_t, std::int64_t) {}
  /// After the last edge. Throws OutputRefused where the books are not complete.
  virtual void finish() {}
};

/// Lines of a GPIO character device (/dev/gpiochipN, Linux 5.10 and later): wheel k's is the k-th. Outputs, low until
/// the first edge; the kernel releases them when the player ends. gpio-sim has such devices without hardware.
class GpioLines : public EdgeOutput {
 public:
  GpioLines(const std::string& chip, const std::vector<std::uint32_t>& lines) : lines_{lines.size()} {
    const int device = ::open(chip.c_str(), O_RDWR | O_CLOEXEC);
    if (device < 0) throw OutputRefused(chip + ": cannot be opened: " + std::strerror(errno));
    gpio_v2_line_request request{};
    for (std::size_t i = 0; i < lines.size() && i < GPIO_V2_LINES_MAX; ++i) request.offsets[i] = lines[i];
    std::strncpy(request.consumer, "crankloop edge_player", sizeof request.consumer - 1);
    request.config.flags = GPIO_V2_LINE_FLAG_OUTPUT;
    request.num_lines = static_cast<__u32>(lines.size());
    const int error = ::ioctl(device, GPIO_V2_GET_LINE_IOCTL, &request) < 0 ? errno : 0;
    ::close(device);
    if (error != 0) throw OutputRefused(chip + ": lines cannot be had: " + std::strerror(error));
    file_ = request.fd;
  }
  ~GpioLines() override { ::close(file_); }

  bool set(std::uint32_t wheel, bool high) noexcept override {
    if (wheel >= lines_) return true;
    gpio_v2_line_values values{};
    values.mask = std::uint64_t{1} << wheel;
    values.bits = high ? values.mask : 0;
    return ::ioctl(file_, GPIO_V2_LINE_SET_VALUES_IOCTL, &values) == 0;
  }

 private:
  std::size_t lines_;
  int file_ = -1;
};

/// A CSV file instead of a device: wheel,level,due_ns,set_ns.
class RecordedLines : public EdgeOutput {
 public:
  explicit RecordedLines(const std::string& path) : path_{path}, file_{std::fopen(path.c_str(), "w")} {
    if (file_ == nullptr) throw OutputRefused(path + ": cannot be created: " + std::strerror(errno));
    std::fputs("wheel,level,due_ns,set_ns\n", file_);
  }
  ~RecordedLines() override {
    if (file_ != nullptr) std::fclose(file_);
  }

  bool set(std::uint32_t, bool) noexcept override { return true; }
  void note(std::uint32_t wheel, bool high, std::uint64_t due_ns, std::int64_t set_ns) override {
    const int written = std::fprintf(file_, "%u,%d,%llu,%lld\n", wheel, high ? 1 : 0,
                                     static_cast<unsigned long long>(due_ns), static_cast<long long>(set_ns));
    if (written < 0 && error_ == 0) error_ = errno;
  }
  void finish() override {
    if (std::fclose(std::exchange(file_, nullptr)) != 0 && error_ == 0) error_ = errno;
    if (error_ != 0) throw OutputRefused(path_ + ": cannot be written: " + std::strerror(error_));
  }

 private:
  std::string path_;
  std::FILE* file_;
  int error_ = 0;  ///< errno's number of the first row that was lost
};

}  // namespace crankloop::port::example
