// Decodes blocks of a packed grid on the device, many at a time, to the bits that the host decodes.
#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>
#include <cstdint>

#include "format/nanovdb/packed_data.h"
#include "gpu/cuda/packed/decode_call.h"
#include "gpu/cuda/packed/packed_view.h"
#include "gpu/cuda/packed/side_stream.h"
#include "gpu/cuda/runtime/device_array.h"

namespace weir {

/// Holds the packed data of one grid on the device that was current when it was made. One stream at a time uses it.
class BlockDecoder {
 public:
  /// Copies all of it. Throws Error(io) where the device has no room.
  explicit BlockDecoder(const PackedData& packed) : BlockDecoder(packed, nullptr) {}
  /// `data` is a copy of its bytes that the device reads, up to a multiple of 16, and must outlive the object; null, or
  /// at no multiple of 16: it copies.
  BlockDecoder(const PackedData& packed, const std::byte* data);

  const PackedView& view() const { return view_; }
  /// Of device memory, beside the data.
  static constexpr std::uint64_t kFixedBytes = std::uint64_t{32} << 20U;

  /// Decodes blocks[i] into values[512 i], i < count, in the order of a leaf (x << 6 | y << 3 | z); both
  /// lie on the device, `values` at a multiple of 16 bytes. A block without a stream gets its region's value, one whose
  /// directory or stream is damaged NaN. Asynchronous on `stream`.
  void decode(const BlockId* blocks, std::size_t count, float* values, cudaStream_t stream) {
    decode(blocks, count, nullptr, values, stream);
  }
  /// The same of min(most, *count_on_device) blocks, or `most` where that is null.
  void decode(const BlockId* blocks, std::size_t most, const std::uint32_t* count_on_device, float* values,
              cudaStream_t stream);

  /// What all calls have met since the last question; waits for `stream`.
  struct Counts {
    std::uint32_t damaged = 0;
    std::uint32_t wide = 0;  ///< whose magnitudes have needed more than 16 bits
  };
  Counts counts(cudaStream_t stream);

 private:
  DeviceArray<std::byte> data_;
  DeviceArray<std::uint16_t> frequencies_;
  DeviceArray<unsigned char> tables_;  // of the entropy coder, as groups of threads load them
  DeviceArray<decode_detail::BlockTask> tasks_;
  DeviceArray<std::uint32_t> order_;
  DeviceArray<std::uint32_t> overflown_;
  DeviceArray<decode_detail::CallCounts> counts_;
  DeviceArray<std::uint32_t> totals_;  // damaged, wide
  SideStream side_;
  PackedView view_;
  unsigned processors_ = 0;
  unsigned narrow_threads_ = 0;
  unsigned wide_threads_ = 0;
};

}  // namespace weir
