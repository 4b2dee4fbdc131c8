#include "tests/compressor/support/failing_allocation.h"

#include <cstdlib>
#include <new>

namespace weir {
namespace {

constexpr int kNever = -1;
thread_local int left = kNever;

void* allocate(std::size_t bytes) {
  if (left != kNever && left-- == 0) throw std::bad_alloc();  // after this, `left` is kNever
  void* const memory = std::malloc(bytes == 0 ? 1 : bytes);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

FailingAllocation::FailingAllocation(int before) { left = before; }
FailingAllocation::~FailingAllocation() { left = kNever; }

}  // namespace weir

// Replace the operators of the standard library in the whole program.
void* operator new(std::size_t bytes) { return weir::allocate(bytes); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
