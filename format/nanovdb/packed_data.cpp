#include "format/nanovdb/packed_data.h"

#include "format/packed/block_decode.h"
#include "format/packed/packed_layout.h"

namespace weir {

namespace {

constexpr auto kBlocksOfGroup = static_cast<unsigned>(packed::chunk::kGroupBlocks);

}  // namespace

PackedData::PackedData(std::span<const std::byte> bytes, std::uint64_t file_offset, const std::string& path,
                       const Box& bbox)
    : bytes_(bytes),
      file_offset_(file_offset),
      path_(path),
      header_(read_packed_header(view(), bbox)),
      constants_(header_.constants()) {}

PackedStream PackedData::stream(const PackedRegion& region, unsigned position) const {
  if (region.chunk == 0) return {};
  const NvdbBytes head = part(region.chunk, region.bytes);
  const PackedGroup group = packed_group(head, region.bytes, position / kBlocksOfGroup);
  const unsigned bit = position % kBlocksOfGroup;
  if (!group.has(bit)) return {};
  const auto found = packed_stream(part(region.chunk + group.begin, group.end - group.begin), group, bit);
  return {found.data(), static_cast<std::uint32_t>(found.size()), packed_means(head)};
}

void PackedData::for_each_stream(const PackedRegion& region,
                                 const std::function<void(unsigned, const PackedStream&)>& visit) const {
  const NvdbBytes head = part(region.chunk, region.bytes);
  const MeanRange means = packed_means(head);
  for (unsigned g = 0; g < packed::chunk::kGroupCount; ++g) {
    const PackedGroup group = packed_group(head, region.bytes, g);
    const NvdbBytes bytes = part(region.chunk + group.begin, group.end - group.begin);
    for (unsigned bit = 0; bit < kBlocksOfGroup; ++bit) {
      const auto found = packed_stream(bytes, group, bit);
      visit(
          g * kBlocksOfGroup + bit,
          found.empty() ? PackedStream{} : PackedStream{found.data(), static_cast<std::uint32_t>(found.size()), means});
    }
  }
}

void PackedData::decode(const PackedStream& stream, std::span<float, 512> values) const {
  decode_packed_stream(constants_, stream, values,
                       file_offset_ + static_cast<std::uint64_t>(stream.data - bytes_.data()), path_);
}

void decode_packed_stream(const BlockConstants& constants, const PackedStream& stream, std::span<float, 512> values,
                          std::uint64_t file_offset, const std::string& path) {
  if (::weir::decode_block(constants, stream.means, stream.data, stream.bytes, values.data())) return;
  const NvdbBytes bytes({stream.data, stream.bytes}, file_offset, path);
  bytes.fail(0, "a block's stream of ", stream.bytes, " bytes and kind ", static_cast<unsigned>(packed_kind(stream)),
             " is damaged");
}

}  // namespace weir
