#include "parallel.hpp"

#include <sched.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace crankloop::program {
namespace {

/// So many threads, the calling one included, or as many as the system allows.
void start(std::vector<std::thread>& others, std::size_t threads, const std::function<void()>& work) {
  others.reserve(threads);
  try {
    while (others.size() + 1 < threads) others.emplace_back(work);
  } catch (const std::exception&) {  // no room for another: those that run do all the work
  }
}

}  // namespace

int processors() {
  cpu_set_t set;
  if (::sched_getaffinity(0, sizeof set, &set) == 0) return std::max(1, CPU_COUNT(&set));
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));  // beyond 1024 processors
}

void run_in_parallel(int threads, std::size_t count, const std::function<void(std::size_t)>& work,
                     const std::function<void()>& after_each) {
  std::atomic<std::size_t> next{0};
  std::mutex one_at_a_time;
  std::size_t first_refused = count;
  std::exception_ptr refused;
  const auto take_turns = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        work(i);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(one_at_a_time);
        if (i < first_refused) refused = std::current_exception();
        first_refused = std::min(first_refused, i);
        next = count;
        return;
      }
      const std::lock_guard<std::mutex> lock(one_at_a_time);
      after_each();
    }
  };
  std::vector<std::thread> others;
  start(others, std::min(static_cast<std::size_t>(threads), count), take_turns);
  take_turns();
  for (std::thread& other : others) other.join();
  if (refused) std::rethrow_exception(refused);
}

}  // namespace crankloop::program
