// Decodes blocks of a packed grid on the device, many at a time, to the bits that the host decodes.
#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>
#include <cstdint>

#include "format/nanovdb/packed_data.h"
#include "gpu/cuda/packed/packed_view.h"
#include "gpu/cuda/runtime/device_array.h"

namespace weir {

/// Holds the packed data of one grid on the device that was current when it was made. One stream at a time uses it.
class BlockDecoder {
 public:
  /// Copies all of it. Throws Error(io) where the device has no room.
  explicit BlockDecoder(const PackedData& packed);

  const PackedView& view() const { return view_; }
  /// Most blocks of one call.
  static constexpr std::size_t kMostBlocks = std::size_t{1} << 22U;

  /// Decodes blocks[i] into values[512 i], i < count <= kMostBlocks, in the order of a leaf (x << 6 | y << 3 | z); both
  /// lie on the device. A block without a stream gets its region's value, one whose directory or stream is damaged
  /// NaN. Asynchronous on `stream`.
  void decode(const PackedBlockId* blocks, std::size_t count, float* values, cudaStream_t stream);

  /// What all calls have met since the last question; waits for `stream`.
  struct Counts {
    std::uint32_t damaged = 0;
    std::uint32_t plain = 0;  ///< that one thread each has decoded from end to end
  };
  Counts counts(cudaStream_t stream);

 private:
  DeviceArray<std::byte> data_;
  DeviceArray<std::uint16_t> tables_;
  DeviceArray<std::uint32_t> left_;      // indices of the blocks that are decoded plainly
  DeviceArray<std::uint32_t> counters_;  // damaged, left in this call, left in all
  PackedView view_;
  unsigned threads_ = 0;
  std::size_t shared_bytes_ = 0;
  unsigned groups_ = 0;
};

}  // namespace weir
