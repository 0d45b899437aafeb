// Counts every call of the heap, by operator new or by malloc, while engines are initialised, stepped a million times,
// copied and restored, and while tables are built: there must be none.
//
// The whole program's heap is the one below: it hands out pieces of an array and takes none back.
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

#include <crankloop/crankloop.hpp>

#include "engines.hpp"

namespace {

volatile unsigned long calls = 0;
alignas(64) unsigned char heap[4 << 20];
std::size_t used = 0;

/// Each piece stands behind its size.
void* piece(std::size_t bytes, std::size_t alignment = 16) {
  calls = calls + 1;
  const std::size_t at = (used + sizeof bytes + alignment - 1) / alignment * alignment;
  if (alignment > 64 || bytes > sizeof heap || at > sizeof heap - bytes) return nullptr;
  std::memcpy(heap + at - sizeof bytes, &bytes, sizeof bytes);
  used = at + bytes;
  return heap + at;
}

}  // namespace

extern "C" {
void* malloc(std::size_t bytes) noexcept { return piece(bytes); }
void* calloc(std::size_t n, std::size_t bytes) noexcept {
  return bytes != 0 && n > sizeof heap / bytes ? nullptr : piece(n * bytes);  // fresh pieces are zero
}
void* realloc(void* old, std::size_t bytes) noexcept {
  void* fresh = piece(bytes);
  if (old != nullptr && fresh != nullptr) {
    std::size_t before = 0;
    std::memcpy(&before, static_cast<unsigned char*>(old) - sizeof before, sizeof before);
    std::memcpy(fresh, old, before < bytes ? before : bytes);
  }
  return fresh;
}
void free(void*) noexcept { calls = calls + 1; }
void* aligned_alloc(std::size_t alignment, std::size_t bytes) noexcept { return piece(bytes, alignment); }
void* memalign(std::size_t alignment, std::size_t bytes) noexcept { return piece(bytes, alignment); }
int posix_memalign(void** where, std::size_t alignment, std::size_t bytes) noexcept {
  *where = piece(bytes, alignment);
  return *where == nullptr ? ENOMEM : 0;
}
}

void* operator new(std::size_t bytes) {
  if (void* at = piece(bytes)) return at;
  std::abort();
}
void operator delete(void*) noexcept { calls = calls + 1; }
void operator delete(void*, std::size_t) noexcept { calls = calls + 1; }

namespace {

constexpr long kSteps = 1'000'000;

bool failed = false;

/// Runs `work` and complains where it called the heap.
template <class Work>
void without_heap(const char* what, Work&& work) {
  const unsigned long before = calls;
  work();
  const unsigned long made = calls - before;
  if (made == 0) return;
  failed = true;
  std::printf("%s: %lu calls of the heap\n", what, made);
}

template <class Engine>
void run(Engine& engine) {
  without_heap(__PRETTY_FUNCTION__, [&] {
    engine = Engine{};
    std::uint32_t faults = 0;
    for (long tick = 0; tick < kSteps; ++tick) faults |= engine.step(input_at<Engine>(tick)).faults;
    if ((faults & crankloop::kFaultSpeed) == 0 || (faults & crankloop::kFaultNotReady) != 0) failed = true;
    const Engine copy = engine;
    if (!engine.restore(copy.state()).ok()) failed = true;
  });
}

/// A count that misses a call would pass for ever.
void try_the_count() {
  const unsigned long before = calls;
  int* volatile one = new int{1};
  delete one;
  void* volatile two = std::malloc(10);
  std::free(two);
  if (calls - before != 4) {
    failed = true;
    std::printf("the count misses calls of the heap: %lu instead of 4\n", calls - before);
  }
}

Engines engines;
crankloop::TableStorage<float, crankloop::scenes::Whole> storage;

}  // namespace

int main() {
  try_the_count();
  without_heap("tables", [] {
    crankloop::EngineDefinition definition;
    definition.crank = {0.095, 0.0575, 0.210, 0.0, 19.0};
    definition.masses.piston_kg = 0.81;
    definition.masses.rod_small_end_kg = 0.505;
    definition.pressure.source = crankloop::PressureSource::wiebe;
    definition.pressure.wiebe.net_mep_Pa = 809.7e3;
    if (!storage.build(definition, {100e-6}).ok()) failed = true;
  });
  std::apply([](auto&... engine) { (run(engine), ...); }, engines);
  if (!failed) std::printf("%zu engines of %ld steps: no call of the heap\n", std::tuple_size_v<Engines>, kSteps);
  return failed ? 1 : 0;
}
