// The exports of module.h: one engine file, one engine that runs, one search.
//
// What belongs here: what an instance holds between calls, and the exports. What does not: how answers are written
// (answers.hpp), the search (redline.hpp), the loops (running.hpp).
#include "../page/module.h"

#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <crankloop/version.h>
#include <crankloop/fmi/name.hpp>

#include "answers.hpp"
#include "crankloop/engine_file/following_springs.hpp"
#include "crankloop/engine_file/gas_order.hpp"
#include "crankloop/engine_file/plausibility.hpp"
#include "crankloop/files/number.hpp"
#include "crankloop/files/text_file.hpp"
#include "crankloop/files/units.hpp"
#include "crankloop/files/words.hpp"
#include "crankloop/loops/fixed_step_loop.hpp"
#include "crankloop/loops/valve_tick_limit.hpp"
#include "engine_facts.hpp"
#include "named_files.hpp"
#include "redline.hpp"
#include "running.hpp"

namespace crankloop::page {
namespace {

using program::EngineFile;
using program::InputError;

/// All that an instance holds between calls.
struct Module {
  std::shared_ptr<const EngineFile> engine;
  std::unique_ptr<Running> running;
  std::vector<std::string> watched;
  RedlineSearch redline;
};

Module& module() {
  static Module the_module;
  return the_module;
}

const EngineFile& loaded() {
  if (module().engine == nullptr) throw InputError("no engine file is loaded");
  return *module().engine;
}
std::string path_of_loaded() { return module().engine == nullptr ? "" : module().engine->path(); }

Running& running() {
  if (module().running == nullptr) throw InputError("no engine runs");
  return *module().running;
}

void add_columns(Json& json, Running& engine) {
  json.open('[').value("time_s").value("crank_deg");
  for (const Probe* column : engine.columns()) json.value(fmi::name_of(column->variable));
  json.close(']');
}

void load(Json& json, const std::string& path, const std::string& text) {
  auto engine = std::make_shared<EngineFile>(program::read_engine_text(text, path, {"engine", "crank", "masses"}));
  std::vector<std::string> warnings = program::warnings_about(*engine);
  for (std::string& line : program::warnings_about_springs_that_follow(*engine)) warnings.push_back(std::move(line));
  add_messages(json, "warnings", warnings, path);
  module().engine = std::move(engine);
}

void start(Json& json, const StartRequest& request) {
  const EngineFile& file = loaded();
  program::require_manifolds(file, request.tick_s);
  program::require_trains(file, request.tick_s);
  std::unique_ptr<Running> engine =
      request.in_double ? start_running<double>(file, request) : start_running<float>(file, request);
  std::vector<std::string> warnings = program::warnings_about_gas(file, request.speed_rpm, request.tick_s);
  const auto more = request.crank_is_free ? program::warnings_about_running_free(file, file.definition())
                                          : program::warnings_about_misfires_left_out(file);
  warnings.insert(warnings.end(), more.begin(), more.end());
  add_messages(json, "warnings", warnings, file.path());
  json.member("settling_cycles", program::cycles_to_settle(file.definition()));
  json.member("ticks_per_cycle", 120 / (std::fabs(request.speed_rpm) * request.tick_s));
  std::vector<std::string> watched;
  for (const std::string& name : module().watched) {
    if (engine->find(name) != nullptr) watched.push_back(name);
  }
  std::string unknown;
  engine->watch(watched, unknown);
  module().running = std::move(engine);
}

void hash(Json& json, double tick_us, bool in_double, double speed_rpm, int cycles) {
  const EngineFile& file = loaded();
  const double tick_s = program::millionths(tick_us);
  program::require_manifolds(file, tick_s);
  program::require_trains(file, tick_s);
  const program::Operation operation{speed_rpm, tick_s, 1, program::gas_order(file.definition().gas)};
  const HashedRun run =
      in_double ? hash_held_run<double>(file, operation, cycles) : hash_held_run<float>(file, operation, cycles);
  json.member("hash", run.hash).member("ticks", run.ticks);
}

void hash_free(Json& json, const StartRequest& request, double seconds) {
  const EngineFile& file = loaded();
  program::require_manifolds(file, request.tick_s);
  program::require_trains(file, request.tick_s);
  const HashedRun run =
      request.in_double ? hash_free_run<double>(file, request, seconds) : hash_free_run<float>(file, request, seconds);
  json.member("hash", run.hash).member("ticks", run.ticks);
}

void require_tick(double tick_us) {
  if (!(tick_us >= 1 && tick_us <= 2000)) throw InputError("the tick is out of range; allowed: 1 to 2000 us");
}

}  // namespace
}  // namespace crankloop::page

using namespace crankloop;        // NOLINT: the exports below are C
using namespace crankloop::page;  // NOLINT

extern "C" {

char* page_take(std::uint32_t bytes) { return static_cast<char*>(std::malloc(bytes > 0 ? bytes : 1)); }
void page_give(char* room) { std::free(room); }

const char* page_facts_of_module(void) {
#if defined(__wasm_simd128__)
  constexpr bool kSimd = true;
#else
  constexpr bool kSimd = false;
#endif
  const std::string version = std::to_string(CRANKLOOP_VERSION_MAJOR) + "." + std::to_string(CRANKLOOP_VERSION_MINOR) +
                              "." + std::to_string(CRANKLOOP_VERSION_PATCH);
  Json json;
  json.open('{').member("version", version).member("simd", kSimd).member("max_samples", kMaxSampleNumbers);
  return answer(json.close('}').text());
}

void page_put_file(const char* name, std::uint32_t name_bytes, const char* text, std::uint32_t bytes) {
  put_file({name, name_bytes}, {text, bytes});
}
void page_forget_files(void) { forget_files(); }

const char* page_load(const char* name, std::uint32_t name_bytes, const char* text, std::uint32_t bytes) {
  const std::string path(name, name_bytes);
  const std::string whole(text, bytes);
  return answer_or_errors(path, [&](Json& json) { load(json, path, whole); });
}

const char* page_facts(void) { return answer(module().engine == nullptr ? "{}" : facts_of(*module().engine)); }
const char* page_keys(void) { return answer(module().engine == nullptr ? "[]" : keys_of(*module().engine)); }

const char* page_start(double tick_us, std::uint32_t in_double, std::uint32_t crank_is_free, double speed_rpm,
                       double crank_deg) {
  return answer_or_errors(path_of_loaded(), [&](Json& json) {
    require_tick(tick_us);
    if (!std::isfinite(speed_rpm) || !std::isfinite(crank_deg)) throw InputError("speed and angle must be finite");
    start(json, {program::millionths(tick_us), in_double != 0, crank_is_free != 0, speed_rpm, crank_deg});
  });
}

const char* page_inputs(void) {
  if (module().running == nullptr) return answer("[]");
  return list_of(running().inputs(), [](Json& json, const Probe& probe) {
    const detail::Variable& variable = probe.variable;
    json.open('{');
    add_variable(json, variable);
    json.member("index", std::string_view(variable.name).find('#') == std::string_view::npos ? 0 : variable.first + 1);
    const bool has_range = variable.least < variable.most;
    json.member("least", has_range ? variable.least : -std::numeric_limits<double>::infinity());
    json.member("most", has_range ? variable.most : std::numeric_limits<double>::infinity()).close('}');
  });
}
double* page_input_values(void) { return module().running == nullptr ? nullptr : running().input_values().data(); }

const char* page_channels(void) {
  if (module().running == nullptr) return answer("[]");
  return list_of(running().channels(), [](Json& json, const Probe& probe) {
    json.open('{');
    add_variable(json, probe.variable);
    json.close('}');
  });
}

const char* page_watch(const char* names, std::uint32_t bytes) {
  return answer_or_errors(path_of_loaded(), [&](Json& json) {
    std::vector<std::string> asked;
    const std::string all(names, bytes);
    for (const std::string_view name : program::split(all, '\n')) {
      if (!name.empty()) asked.emplace_back(name);
    }
    std::string unknown;
    if (!running().watch(asked, unknown)) throw InputError("the engine has no " + program::in_quotes(unknown));
    module().watched = asked;
    json.key("columns");
    add_columns(json, running());
  });
}
const char* page_columns(void) {
  if (module().running == nullptr) return answer("[]");
  Json json;
  add_columns(json, running());
  return answer(json.text());
}

std::uint32_t page_step(std::uint32_t ticks, std::uint32_t every) {
  return module().running == nullptr ? 0 : running().step(ticks, every);
}
const double* page_samples(void) { return module().running == nullptr ? nullptr : running().samples().data(); }
std::uint32_t page_sample_count(void) {
  return module().running == nullptr ? 0 : static_cast<std::uint32_t>(running().sample_count());
}
const double* page_now(void) { return module().running == nullptr ? nullptr : running().now().data(); }

const double* page_edges(void) { return module().running == nullptr ? nullptr : running().edges().data(); }
std::uint32_t page_edge_count(void) {
  return module().running == nullptr ? 0 : static_cast<std::uint32_t>(running().edges().size() / 3);
}
std::uint32_t page_edges_lost(void) { return module().running == nullptr ? 0 : running().edges_lost(); }

std::uint32_t page_cycles(void) { return module().running == nullptr ? 0 : running().cycles(); }
const char* page_results(void) {
  if (module().running == nullptr) return answer("[]");
  return list_of(running().results(), [](Json& json, const detail::Variable& variable) {
    const std::string_view name = variable.name;
    json.open('{');
    add_variable(json, variable);
    json.member("of", name.find("#,#") != std::string_view::npos ? "valve"
                      : name.find('#') != std::string_view::npos ? "cylinder"
                                                                 : "engine");
    json.close('}');
  });
}
const double* page_result_values(void) {
  return module().running == nullptr ? nullptr : running().result_values().data();
}

const char* page_hash(double tick_us, std::uint32_t in_double, double speed_rpm, std::uint32_t cycles) {
  return answer_or_errors(path_of_loaded(), [&](Json& json) {
    require_tick(tick_us);
    if (!(speed_rpm > 0 && speed_rpm <= 100000))
      throw InputError("the speed is out of range; allowed: above 0, at most 100000 rpm");
    if (cycles < 1 || cycles > 1000) throw InputError("the cycles are out of range; allowed: 1 to 1000");
    hash(json, tick_us, in_double != 0, speed_rpm, static_cast<int>(cycles));
  });
}

const char* page_hash_free(double tick_us, std::uint32_t in_double, double speed_rpm, double seconds) {
  return answer_or_errors(path_of_loaded(), [&](Json& json) {
    require_tick(tick_us);
    if (!std::isfinite(speed_rpm)) throw InputError("the speed must be finite");
    if (!(seconds > 0 && seconds <= 100)) throw InputError("the time is out of range; allowed: above 0, at most 100 s");
    hash_free(json, {program::millionths(tick_us), in_double != 0, true, speed_rpm, 0}, seconds);
  });
}

const char* page_redline(const char* train, std::uint32_t bytes, std::uint32_t from_rpm, std::uint32_t to_rpm) {
  return answer_or_errors(path_of_loaded(), [&](Json& json) {
    if (from_rpm > 100000 || to_rpm > 100000)
      throw InputError("the speed is out of range; allowed: at most 100000 rpm");
    (void)loaded();
    module().redline.begin(json, module().engine, {train, bytes}, static_cast<int>(from_rpm), static_cast<int>(to_rpm));
  });
}
const char* page_redline_step(void) {
  return answer_or_errors(path_of_loaded(), [&](Json& json) { module().redline.step(json); });
}

}  // extern "C"
