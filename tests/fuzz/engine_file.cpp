// Any bytes as an engine file: it is refused with a line for each error, or shown as a file that shows the same.
#include "crankloop/engine_file/engine_file.hpp"

#include <algorithm>

#include "fuzz.hpp"

using namespace crankloop;
using namespace crankloop::program;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::TextFile file("engine.ini");
  static const fuzz::TextFile again("engine.ini");
  file.write(data, size);
  std::string shown;
  try {
    shown = show(read_engine_file(file.path(), {}));
  } catch (const InputError& refusal) {
    const std::string message = refusal.what();
    fuzz::must(!message.empty() && message.back() != '\n' && std::count(message.begin(), message.end(), '\n') < 20,
               "a refusal is 1 to 20 lines");
    return 0;
  }
  again.write(shown.data(), shown.size());
  try {
    fuzz::must(show(read_engine_file(again.path(), {})) == shown, "what is shown shows the same");
  } catch (const InputError& refusal) {
    // A table is named relative to its file, which the second one is not beside.
    fuzz::must(shown.find("\nfile = ") != std::string::npos, refusal.what());
  }
  return 0;
}
