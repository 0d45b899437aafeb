// The machine of port/common/machine.hpp where it is a process: for the images that also run on the building machine.
#include "port/common/machine.hpp"

#include <unistd.h>

#include <cstring>

namespace crankloop::port {

// To standard error, as semihosting does; what cannot be written is lost.
void write(const char* text) noexcept { static_cast<void>(!::write(STDERR_FILENO, text, std::strlen(text))); }

void finish(int status) noexcept { ::_exit(status); }

std::uint32_t counter() noexcept { return 0; }

std::uint32_t instructions_between(std::uint32_t, std::uint32_t) noexcept { return 0; }

FreeStack free_stack() noexcept { return {nullptr, nullptr}; }

}  // namespace crankloop::port
