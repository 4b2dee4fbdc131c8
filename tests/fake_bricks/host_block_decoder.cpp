// In place of the kernels that decode: blocks one after the other, out of memory that is allocated as on a device.
#include <algorithm>
#include <limits>

#include "format/packed/block_decode.h"
#include "gpu/cuda/packed/block_decoder.h"

namespace weir {

constexpr std::size_t kTogether = 16;

BlockDecoder::BlockDecoder(const PackedData& packed, const std::byte* data)
    : frequencies_(packed.header().frequencies),
      tables_(1),
      tasks_(kTogether),
      order_(kTogether),
      overflown_(kTogether),
      counts_(1),
      totals_(2) {
  if (data == nullptr || reinterpret_cast<std::uintptr_t>(data) % 16 != 0) {
    data_ = DeviceArray<std::byte>((packed.bytes().size() + 15) / 16 * 16);
    data_.upload(packed.bytes());
    data = data_.data();
  }
  std::fill_n(totals_.data(), 2, 0U);
  const PackedHeader& header = packed.header();
  view_.data = data;
  view_.bytes = packed.bytes().size();
  view_.table = header.table;
  view_.regions = static_cast<std::uint64_t>(header.regions.size());
  view_.constants = header.values;
  view_.constants.tables = frequencies_.data();
  processors_ = narrow_threads_ = wide_threads_ = 1;  // of which the kernels make their grids
}

void BlockDecoder::decode(const BlockId* blocks, std::size_t most, const std::uint32_t* count_on_device, float* values,
                          cudaStream_t /*stream*/) {
  if (count_on_device != nullptr) most = std::min<std::size_t>(most, *count_on_device);
  for (std::size_t i = 0; i < most; ++i) {
    float* const block = values + 512 * i;
    const FoundStream found = find_stream(view_, blocks[i]);
    std::fill_n(block, 512, found.damaged ? std::numeric_limits<float>::quiet_NaN() : found.value);
    if (found.data == nullptr) continue;
    if (!decode_block(view_.constants, found.means, found.data, found.bytes, block)) {
      std::fill_n(block, 512, std::numeric_limits<float>::quiet_NaN());
      ++totals_.data()[0];
    }
  }
}

BlockDecoder::Counts BlockDecoder::counts(cudaStream_t /*stream*/) {
  const Counts found{totals_.data()[0], totals_.data()[1]};
  std::fill_n(totals_.data(), 2, 0U);
  return found;
}

}  // namespace weir
