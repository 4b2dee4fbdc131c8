// Of the pretended device.
#include "tests/cuda/support/refused_allocations.h"

#include "tests/fake_cuda/fake_runtime.h"

namespace weir::test {

std::uint64_t allocations() { return FakeRuntime::instance().calls("allocation"); }

std::uint64_t refusal_step() { return 7; }

RefusedAllocations::RefusedAllocations(std::uint64_t nth, bool lasting) {
  FakeRuntime& runtime = FakeRuntime::instance();
  if (lasting) {
    runtime.fail_from("allocation", static_cast<int>(nth), cudaErrorMemoryAllocation);
  } else {
    runtime.fail("allocation", static_cast<int>(nth), cudaErrorMemoryAllocation);
  }
}

RefusedAllocations::~RefusedAllocations() { FakeRuntime::instance().heal(); }

}  // namespace weir::test
