// Many independent points on many processors.
//
// What belongs here: threads. What does not: points on many machines (shards.hpp).
#pragma once

#include <cstddef>
#include <functional>

namespace crankloop::program {

/// Those that this process may use, at least 1: fewer than the machine has under taskset, Slurm and the like.
[[nodiscard]] int processors();

/// Calls work(0) to work(count - 1), each once, `threads` of them at a time or as many as the system allows, and
/// after_each() after each, by one thread at a time. Of exceptions the one of the lowest number is thrown, at the end;
/// later numbers may then be left out.
void run_in_parallel(int threads, std::size_t count, const std::function<void(std::size_t)>& work,
                     const std::function<void()>& after_each);

}  // namespace crankloop::program
