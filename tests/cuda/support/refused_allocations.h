// A device that refuses memory when a test asks for it. In weir_tests_cuda the linker first leads calls of the
// runtime's allocating functions here (--wrap).
#pragma once

#include <cstdint>

namespace weir::test {

/// Returns the number of allocations so far: device memory, page-locked memory, arrays, textures, surfaces, streams
/// and events.
std::uint64_t allocations();

/// Returns n: a test of a large volume refuses every n-th of its allocations. n is 1 on a device, and larger if
/// kernels run on the host.
std::uint64_t refusal_step();

/// While the object lives, refuses the n-th allocation after its construction (0: the next one), and all later ones
/// if `lasting` is set.
class RefusedAllocations {
 public:
  RefusedAllocations(std::uint64_t nth, bool lasting);
  ~RefusedAllocations();
  RefusedAllocations(const RefusedAllocations&) = delete;
  RefusedAllocations& operator=(const RefusedAllocations&) = delete;
};

}  // namespace weir::test
