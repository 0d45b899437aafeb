// Text without a C library: the few forms that the images print.
#pragma once

#include <cstddef>
#include <cstdint>

#include "port/common/machine.hpp"

namespace crankloop::port {

/// Shown by 16 hexadecimal digits.
struct Hex {
  std::uint64_t value;
};

/// A line in the making; what does not fit is left off. Written at its end in one piece: each write through semihosting
/// is a trap.
class Line {
 public:
  Line() = default;
  Line(const Line&) = delete;
  Line& operator=(const Line&) = delete;
  ~Line() {
    add('\n');
    write(text_);
  }

  Line& operator<<(const char* text) noexcept {
    for (; *text != '\0'; ++text) add(*text);
    return *this;
  }
  Line& operator<<(std::uint32_t number) noexcept {
    char digits[10];
    std::size_t n = 0;
    do digits[n++] = static_cast<char>('0' + number % 10);
    while ((number /= 10) != 0);
    while (n > 0) add(digits[--n]);
    return *this;
  }
  Line& operator<<(Hex number) noexcept {
    for (int shift = 60; shift >= 0; shift -= 4) add("0123456789ABCDEF"[(number.value >> shift) & 15]);
    return *this;
  }

 private:
  void add(char c) noexcept {
    if (used_ + 1 < sizeof text_) text_[used_++] = c;
  }
  char text_[200] = {};
  std::size_t used_ = 0;
};

}  // namespace crankloop::port
