#include "gpu/cuda/volume/device_memory.h"

#include <gtest/gtest.h>

#include <limits>
#include <memory>

#include "gpu/cuda/render/cuda_backend.h"
#include "gpu/cuda/runtime/device_array.h"
#include "tests/cuda/support/device_reads.h"

namespace weir::device_memory_test {
namespace {

constexpr std::uint64_t kMuch = 1ULL << 30U;

// A back end's pool keeps what is given back to it.
TEST(FreeDeviceBytes, ReleasesThePoolsReserveWhenItIsWanted) {
  WEIR_NEEDS_DEVICE();
  const auto backend = make_cuda_backend({});
  constexpr std::uint64_t kAll = std::numeric_limits<std::uint64_t>::max();
  const std::uint64_t before = free_device_bytes(kAll);
  { const DeviceArray<std::byte> much(kMuch); }
  EXPECT_LE(free_device_bytes(0) + kMuch, before);
  EXPECT_EQ(free_device_bytes(before), before);
}

}  // namespace
}  // namespace weir::device_memory_test
