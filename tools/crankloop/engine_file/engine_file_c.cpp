// Engine files for C: crankloop/crankloop_engine_file.h.
#include <crankloop/crankloop_engine_file.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <memory>
#include <string>
#include <utility>

#include "port/c/definition.hpp"

#include "engine_file.hpp"

struct crankloop_engine_file {
  crankloop::program::EngineFile engine;
  crankloop_definition definition;
};

namespace crankloop::program {
namespace {

EngineFile read(const char* path, const char* text, std::size_t size) {
  if (path == nullptr) throw InputError("path is null");
  const std::vector<std::string> needed = {"engine", "crank", "masses"};
  EngineFile engine =
      text == nullptr ? read_engine_file(path, needed) : read_engine_text(std::string(text, size), path, needed);
  if (engine.definition().pressure.source == PressureSource::gas) {
    throw InputError(
        path, engine.section("pressure").line_of("source"),
        "source: the ready-made engines of the C interface have no gas; a scene of crankloop_add_scene has");
  }
  return engine;
}

}  // namespace
}  // namespace crankloop::program

crankloop_engine_file* crankloop_engine_file_read(const char* path, const char* text, std::size_t text_size,
                                                  char* errors, std::size_t room) {
  if (errors == nullptr) room = 0;
  if (room > 0) errors[0] = '\0';
  try {
    auto engine = crankloop::program::read(path, text, text_size);
    const crankloop_definition definition = crankloop::c::as_c(engine.definition());
    return new crankloop_engine_file{std::move(engine), definition};
  } catch (const std::exception& error) {
    if (room > 0) {
      const std::size_t length = std::min(std::strlen(error.what()), room - 1);
      std::memcpy(errors, error.what(), length);
      errors[length] = '\0';
    }
    return nullptr;
  }
}

const crankloop_definition* crankloop_engine_file_definition(const crankloop_engine_file* file, std::size_t* size) {
  if (size != nullptr) *size = sizeof file->definition;
  return file == nullptr ? nullptr : &file->definition;
}

void crankloop_engine_file_free(crankloop_engine_file* file) { delete file; }
