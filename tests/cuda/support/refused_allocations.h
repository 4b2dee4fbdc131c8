// A device that refuses memory when a test wants it to: the runtime's functions that allocate something, which the
// linker leads here first (--wrap), in weir_tests_cuda.
#pragma once

#include <cstdint>

namespace weir::test {

/// Allocations so far: of device memory, page-locked memory, arrays, textures, surfaces, streams and events.
std::uint64_t allocations();

/// Of the allocations of a large volume, each how manieth a test is to refuse: every one on a device, fewer where
/// kernels run on the host.
std::uint64_t refusal_step();

/// While it lives, the n-th allocation from its making on (0: the next) is refused, and all later ones where `lasting`.
class RefusedAllocations {
 public:
  RefusedAllocations(std::uint64_t nth, bool lasting);
  ~RefusedAllocations();
  RefusedAllocations(const RefusedAllocations&) = delete;
  RefusedAllocations& operator=(const RefusedAllocations&) = delete;
};

}  // namespace weir::test
