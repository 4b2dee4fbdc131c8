#include <algorithm>

#include "format/base/error.h"
#include "gpu/cuda/push/gather_planes.h"
#include "gpu/cuda/runtime/launch_kernel.cuh"

namespace weir {
namespace {

struct Strides {
  std::int64_t x, y, z;  // in values
};

// Neighbouring threads write neighbouring values, so that whole lines cross the bus.
template <typename Word>
__global__ void gather(const Word* first, Strides stride, std::int64_t columns, std::int64_t rows, std::int64_t values,
                       Word* to) {
  const std::int64_t step = std::int64_t{gridDim.x} * blockDim.x;
  for (std::int64_t i = std::int64_t{blockIdx.x} * blockDim.x + threadIdx.x; i < values; i += step) {
    const std::int64_t row = i / columns;
    const std::int64_t x = i - row * columns;
    const std::int64_t z = row / rows;
    const std::int64_t y = row - z * rows;
    to[i] = first[x * stride.x + y * stride.y + z * stride.z];
  }
}

template <typename Word>
void gather_words(const DeviceValues& from, const Index3& extent, std::byte* to, cudaStream_t stream) {
  constexpr int kThreads = 256;
  constexpr std::int64_t kMostBlocks = 2048;  // enough to fill every device; each thread takes several values
  const auto bytes = static_cast<std::int64_t>(sizeof(Word));
  const std::int64_t values = volume(extent);
  const auto blocks =
      static_cast<unsigned>(std::clamp<std::int64_t>((values + kThreads - 1) / kThreads, 1, kMostBlocks));
  launch_kernel("gathering a slab on the device", {blocks, kThreads, stream}, gather<Word>,
                reinterpret_cast<const Word*>(from.first),
                Strides{from.stride[0] / bytes, from.stride[1] / bytes, from.stride[2] / bytes}, extent.x, extent.y,
                values, reinterpret_cast<Word*>(to));
}

}  // namespace

void gather_planes(const DeviceValues& from, const Index3& extent, std::byte* to, cudaStream_t stream) {
  switch (from.value_bytes) {
    case 1:
      return gather_words<std::uint8_t>(from, extent, to, stream);
    case 2:
      return gather_words<std::uint16_t>(from, extent, to, stream);
    case 4:
      return gather_words<std::uint32_t>(from, extent, to, stream);
    case 8:
      return gather_words<std::uint64_t>(from, extent, to, stream);
    default:
      throw Error(ErrorKind::internal, "values of this many bytes cannot be gathered");
  }
}

}  // namespace weir
