// libFuzzer target for the chunks and shards of Zarr arrays. The first byte selects a codec chain or a shard index. Any
// bytes must decode to the size of a chunk, parse to places inside the shard, or throw Error with a message of one
// line.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "format/base/error.h"
#include "ingest/zarr/codecs/codec_chain.h"
#include "ingest/zarr/storage/shard_index.h"

namespace {

using weir::ZarrFilter;
using weir::ZarrPacker;

const ZarrFilter kDelta{ZarrFilter::Kind::delta, 1, weir::ScalarType::int32, true};
const std::array<weir::ZarrCodecs, 10> kChains{
    {{{}, false, {}},
     {{2, 0, 1}, false, {ZarrPacker::zlib}},
     {{}, false, {ZarrPacker::gzip}},
     {{2, 1, 0}, false, {ZarrPacker::zstd}},
     {{}, false, {ZarrPacker::blosc}},
     {{0, 2, 1}, false, {ZarrPacker::crc32c}},
     {{}, false, {ZarrPacker::zstd, ZarrPacker::gzip}},
     {{}, false, {ZarrPacker::blosc, ZarrPacker::crc32c}},
     {{2, 1, 0}, true, {}, {kDelta, {ZarrFilter::Kind::shuffle, 4}}},
     {{}, false, {ZarrPacker::zlib}, {{ZarrFilter::Kind::shuffle, 3}, kDelta}}}};
const weir::ChunkShape kShape{{3, 5, 7}, 4};

void check_chunk(const weir::ZarrCodecs& codecs, std::span<const std::byte> stored) {
  const weir::ScratchSize size = weir::scratch_size(codecs, kShape.bytes());
  weir::ChunkScratch scratch(size.buffer_bytes, size.two);
  if (stored.size() > size.buffer_bytes) return;
  std::copy(stored.begin(), stored.end(), scratch.buffer.bytes().begin());
  if (weir::decode_chunk(codecs, kShape, stored.size(), scratch).size() != kShape.bytes()) std::abort();
}

void check_index(bool big_endian, std::span<const std::byte> stored) {
  weir::ZarrSharding sharding;
  sharding.index_big_endian = big_endian;
  const std::uint64_t bytes = weir::shard_index_bytes(sharding, stored.size() / 16);
  std::vector<std::byte> index(stored.begin(), stored.begin() + static_cast<std::ptrdiff_t>(bytes));
  constexpr std::uint64_t kShardBytes = 1000;
  for (const weir::ShardPlace& place : weir::parse_shard_index(sharding, index, kShardBytes, "fuzz")) {
    if (!place.stored()) continue;
    if (place.offset > kShardBytes || place.bytes > kShardBytes - place.offset) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::span stored(reinterpret_cast<const std::byte*>(data) + 1, size - 1);
  try {
    const std::size_t kind = data[0] % (kChains.size() + 2);
    if (kind < kChains.size()) {
      check_chunk(kChains.at(kind), stored);
    } else {
      check_index(kind > kChains.size(), stored);
    }
  } catch (const weir::Error& error) {
    if (std::string_view(error.what()).find('\n') != std::string_view::npos) std::abort();
  }
  return 0;
}
