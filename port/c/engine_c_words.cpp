// Refusals of the C interface in words.
//
// A separate source in the host's library and in every scene's that has a C interface: each archive holds it as a
// member of its own, of which a program links one, and none where it prints no refusal.
#include <crankloop/crankloop.h>

#include <cstddef>
#include <cstdint>

#include <crankloop/status.hpp>

using namespace crankloop;

const char* crankloop_describe(std::int32_t reason) {
  const bool known = reason >= 0 && reason <= CRANKLOOP_UNSTABLE;
  return known ? describe(static_cast<Reason>(reason)) : "unknown reason";
}

std::size_t crankloop_status_text(crankloop_status status, char* text, std::size_t room) {
  if (text == nullptr) room = 0;
  std::size_t length = 0;
  const auto add = [&](char letter) {
    if (length + 1 < room) text[length] = letter;
    ++length;
  };
  const auto add_all = [&](const char* words) {
    while (words != nullptr && *words != '\0') add(*words++);
  };
  add_all(status.field);
  if (status.index >= 0) {
    char digits[10];
    int count = 0;
    for (std::int32_t rest = status.index; rest > 0 || count == 0; rest /= 10)
      digits[count++] = static_cast<char>('0' + rest % 10);
    add('[');
    while (count > 0) add(digits[--count]);
    add(']');
  }
  if (length > 0) add(' ');
  add_all(crankloop_describe(status.reason));
  if (room > 0) text[length < room ? length : room - 1] = '\0';
  return length;
}
