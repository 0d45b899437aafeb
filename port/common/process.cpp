// The machine of port/common/machine.hpp where an operating system runs processes: Linux, Windows.
#include <cstdio>
#include <cstdlib>

#include "port/common/machine.hpp"

namespace crankloop::port {

// To standard error, as semihosting does; what cannot be written is lost.
void write(const char* text) noexcept { static_cast<void>(std::fputs(text, stderr)); }

void finish(int status) noexcept { std::_Exit(status); }

std::uint32_t counter() noexcept { return 0; }

std::uint32_t instructions_between(std::uint32_t, std::uint32_t) noexcept { return 0; }

FreeStack free_stack() noexcept { return {nullptr, nullptr}; }

}  // namespace crankloop::port
