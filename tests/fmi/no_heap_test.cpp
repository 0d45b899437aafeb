// A step, a get, a set: none calls the heap. The program's heap is counted, and an FMU calls the program's.
#include <atomic>
#include <cstddef>

#include <gtest/gtest.h>

#include "fmu.hpp"

namespace {

std::atomic<long> calls{0};

}  // namespace

extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void __libc_free(void*);
void* malloc(std::size_t bytes) noexcept { return ++calls, __libc_malloc(bytes); }
void* calloc(std::size_t n, std::size_t bytes) noexcept { return ++calls, __libc_calloc(n, bytes); }
void* realloc(void* old, std::size_t bytes) noexcept { return ++calls, __libc_realloc(old, bytes); }
void free(void* memory) noexcept { return ++calls, __libc_free(memory); }
}

namespace {

TEST(NoHeap, IsCalledByAStep) {
  for (const char* name : {"whole", "free_running", "breathing_free", "trigger_wheels", "bouncing_valve"}) {
    for (const char* version : {"2", "3"}) {
      const fmu::Fmu fmu(std::string(FMU_DIR) + "/" + name + "_fmi" + version + ".fmu");
      const long before_instance = calls;
      fmu::Unit unit(fmu);
      EXPECT_GT(calls, before_instance) << "the counting works: an instance takes memory";
      ASSERT_NO_FATAL_FAILURE(unit.start());
      const std::uint32_t input = 1;
      const std::uint32_t outputs[] = {8, 9};
      double values[] = {55, 0};
      const long before = calls;
      for (int k = 0; k < 1'000; ++k) {
        unit_set_real(unit.unit, &input, 1, values);
        unit_step(unit.unit, k * 1e-3, 1e-3);
        unit_get_real(unit.unit, outputs, 2, values);
        values[0] = k % 100 == 99 ? HUGE_VAL : 55;  // faults are told, too
        unit_step(unit.unit, 1e6, 1e-3);            // and refusals
      }
      EXPECT_EQ(calls, before) << name;
    }
  }
}

}  // namespace
