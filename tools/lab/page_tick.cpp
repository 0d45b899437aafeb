// crankloop_page_tick FILE float|double held|free TICK_US: ns a tick of what a page does in each tick, at rated speed,
// compiled for this processor. tests/page/real_time.mjs times the page's module beside it.
#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "port/linux/stopwatch.hpp"
#include "port/wasm/module/running.hpp"

namespace {

using namespace crankloop;

// As real_time.mjs has them: short batches, because a busy machine interrupts long ones.
constexpr int kBatches = 301;
constexpr std::uint32_t kBatchTicks = 200;

double tick_ns(page::Running& engine) {
  engine.step(100 * kBatchTicks, 0);
  std::array<double, kBatches> batch{};
  for (double& per_tick_ns : batch) {
    const port::Stopwatch stopwatch;
    engine.step(kBatchTicks, 0);
    per_tick_ns = static_cast<double>(stopwatch.elapsed_ns()) / kBatchTicks;
  }
  std::nth_element(batch.begin(), batch.begin() + kBatches / 4, batch.end());
  return batch[kBatches / 4];
}

}  // namespace

int main(int argc, char** argv) try {
  const std::vector<std::string> words(argv + 1, argv + argc);
  const auto is_one_of = [&](std::size_t word, const char* a, const char* b) {
    return words[word] == a || words[word] == b;
  };
  if (words.size() != 4 || !is_one_of(1, "float", "double") || !is_one_of(2, "held", "free")) {
    std::fputs("usage: crankloop_page_tick FILE float|double held|free TICK_US\n", stderr);
    return 2;
  }
  const program::EngineFile file = program::read_engine_file(words[0], {"engine", "crank", "masses"});
  page::StartRequest request;
  request.in_double = words[1] == "double";
  request.crank_is_free = words[2] == "free";
  request.tick_s = std::stod(words[3]) * 1e-6;
  request.speed_rpm = file.rated_rpm();
  const auto engine =
      request.in_double ? page::start_running<double>(file, request) : page::start_running<float>(file, request);
  std::printf("%.1f\n", tick_ns(*engine));
} catch (const std::exception& error) {
  std::fprintf(stderr, "crankloop_page_tick: %s\n", error.what());
  return 2;
}
