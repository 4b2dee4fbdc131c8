// Decodes many blocks of a packed grid at a time on the device, to exactly the bits that the host decodes.
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

/// Holds the packed data of one grid on the device that is current at construction. One stream at a time may use it.
class BlockDecoder {
 public:
  /// Copies all data to the device. Throws Error(io) if the device has no room.
  explicit BlockDecoder(const PackedData& packed) : BlockDecoder(packed, nullptr) {}
  /// `data` is a copy of the packed bytes that the device reads, rounded up to a multiple of 16. It must outlive the
  /// object. If it is null or not at a multiple of 16, the constructor makes a copy.
  BlockDecoder(const PackedData& packed, const std::byte* data);

  const PackedView& view() const { return view_; }
  /// Bytes of device memory besides the data.
  static constexpr std::uint64_t kFixedBytes = std::uint64_t{32} << 20U;

  /// Decodes blocks[i] into values[512 i], i < count, in the order of a leaf (x << 6 | y << 3 | z). Both arrays lie
  /// on the device, `values` at a multiple of 16 bytes. A block without a stream gets its region's value; a block
  /// with a damaged directory or stream gets NaN. Asynchronous on `stream`.
  void decode(const BlockId* blocks, std::size_t count, float* values, cudaStream_t stream) {
    decode(blocks, count, nullptr, values, stream);
  }
  /// Decodes min(most, *count_on_device) blocks, or `most` if `count_on_device` is null.
  void decode(const BlockId* blocks, std::size_t most, const std::uint32_t* count_on_device, float* values,
              cudaStream_t stream);

  /// What all calls since the last counts() have met. counts() waits for `stream`, and begins to count anew.
  struct Counts {
    std::uint32_t damaged = 0;
    std::uint32_t wide = 0;  ///< blocks with magnitudes of more than 16 bits
  };
  Counts counts(cudaStream_t stream);

 private:
  DeviceArray<std::byte> data_;
  DeviceArray<std::uint16_t> frequencies_;
  DeviceArray<unsigned char> tables_;  // of the entropy coder, in the layout that groups of threads load
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
