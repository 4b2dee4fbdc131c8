#include "tests/cuda/support/refused_allocations.h"

#include <cuda_runtime_api.h>

#include <atomic>
#include <cstddef>

namespace weir::test {
namespace {

constexpr std::uint64_t kNever = ~std::uint64_t{0};

std::atomic<std::uint64_t> calls{0};
std::atomic<std::uint64_t> first_refused{kNever};
std::atomic<std::uint64_t> last_refused{kNever};

bool refused() {
  const std::uint64_t call = calls++;
  return call >= first_refused && call <= last_refused;
}

}  // namespace

std::uint64_t allocations() { return calls; }

std::uint64_t refusal_step() { return 1; }

RefusedAllocations::RefusedAllocations(std::uint64_t nth, bool lasting) {
  last_refused = lasting ? kNever : calls + nth;
  first_refused = calls + nth;
}

RefusedAllocations::~RefusedAllocations() { first_refused = kNever; }

}  // namespace weir::test

// NOLINTBEGIN(bugprone-reserved-identifier): the linker's names
#define WEIR_WRAP(function, parameters, arguments)               \
  extern "C" cudaError_t __real_##function parameters;           \
  extern "C" cudaError_t __wrap_##function parameters {          \
    if (weir::test::refused()) return cudaErrorMemoryAllocation; \
    return __real_##function arguments;                          \
  }

// The variants with one default stream for all threads, and with one per thread.
WEIR_WRAP(cudaMallocAsync, (void** memory, std::size_t bytes, cudaStream_t stream), (memory, bytes, stream))
WEIR_WRAP(cudaMallocAsync_ptsz, (void** memory, std::size_t bytes, cudaStream_t stream), (memory, bytes, stream))
WEIR_WRAP(cudaHostAlloc, (void** memory, std::size_t bytes, unsigned flags), (memory, bytes, flags))
WEIR_WRAP(cudaMalloc3DArray,
          (cudaArray_t * array, const cudaChannelFormatDesc* format, cudaExtent extent, unsigned flags),
          (array, format, extent, flags))
WEIR_WRAP(cudaCreateTextureObject,
          (cudaTextureObject_t * object, const cudaResourceDesc* resource, const cudaTextureDesc* how,
           const cudaResourceViewDesc* view),
          (object, resource, how, view))
WEIR_WRAP(cudaCreateSurfaceObject, (cudaSurfaceObject_t * object, const cudaResourceDesc* resource), (object, resource))
WEIR_WRAP(cudaStreamCreateWithFlags, (cudaStream_t * stream, unsigned flags), (stream, flags))
WEIR_WRAP(cudaEventCreateWithFlags, (cudaEvent_t * event, unsigned flags), (event, flags))
// NOLINTEND(bugprone-reserved-identifier)
