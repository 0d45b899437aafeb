// Two threads, each with its own engine, on the same tables: every scene, stepped at the same time, answers what one
// thread alone does. Built with -fsanitize=thread it also says whether they share anything.
//
//   two_threads          exit status 0 when all is well
//   two_threads --race   both threads step one engine: what the thread sanitizer must complain about
#include <cstdio>
#include <cstring>
#include <memory>
#include <thread>

#include "engines.hpp"

namespace {

constexpr long kSteps = 20'000;

template <class Engine>
void run(Engine& engine) {
  for (long tick = 0; tick < kSteps; ++tick) engine.step(input_at<Engine>(tick));
}

template <class State>
bool same_bits(const State& a, const State& b) {
  return std::memcmp(&a, &b, sizeof(State)) == 0;  // a state has no padding
}

template <class Engine>
bool two_threads_agree() {
  const auto alone = std::make_unique<Engine>();
  run(*alone);
  const auto one = std::make_unique<Engine>();
  const auto other = std::make_unique<Engine>();
  std::thread neighbour([&] { run(*other); });
  run(*one);
  neighbour.join();
  if (same_bits(one->state(), alone->state()) && same_bits(other->state(), alone->state())) return true;
  std::printf("not as alone: %s\n", __PRETTY_FUNCTION__);
  return false;
}

template <class Engine>
void race() {
  Engine engine;
  std::thread neighbour([&] { run(engine); });
  run(engine);
  neighbour.join();
}

template <class... Engine>
bool all_agree(const std::tuple<Engine...>*) {
  return (two_threads_agree<Engine>() & ...);
}

}  // namespace

int main(int count, char** words) {
  if (count > 1 && std::strcmp(words[1], "--race") == 0) {
    race<TorqueOnly_float::Engine>();
    return 0;
  }
  return all_agree(static_cast<const Engines*>(nullptr)) ? 0 : 1;
}
