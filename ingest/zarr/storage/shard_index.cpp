#include "ingest/zarr/storage/shard_index.h"

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/zarr/codecs/crc32c.h"

namespace weir {
namespace {

constexpr std::size_t kNumberBytes = 8;
constexpr std::size_t kPlaceBytes = 2 * kNumberBytes;

std::uint64_t number_at(std::span<const std::byte> index, std::size_t at, bool big_endian) {
  std::uint64_t number = 0;
  for (std::size_t i = 0; i < kNumberBytes; ++i) {
    number = number << 8U | std::to_integer<std::uint64_t>(index[at + (big_endian ? i : kNumberBytes - 1 - i)]);
  }
  return number;
}

}  // namespace

std::uint64_t shard_index_bytes(const ZarrSharding& sharding, std::uint64_t chunks) {
  return chunks * kPlaceBytes + (sharding.index_checksum ? kCrc32cBytes : 0);
}

std::vector<ShardPlace> parse_shard_index(const ZarrSharding& sharding, std::span<std::byte> index,
                                          std::uint64_t shard_bytes, const std::string& where) {
  const std::uint64_t index_begin = sharding.index_first ? 0 : shard_bytes - index.size();
  const std::uint64_t index_end = index_begin + index.size();
  if (sharding.index_checksum) {
    try {
      index = check_crc32c(index);
    } catch (const Error& error) {
      throw Error(error.kind(), compose(where, ": index of the shard: ", error.message(), "; the file is damaged"));
    }
  }
  std::vector<ShardPlace> places(index.size() / kPlaceBytes);
  for (std::size_t i = 0; i < places.size(); ++i) {
    ShardPlace& place = places[i];
    place = {number_at(index, i * kPlaceBytes, sharding.index_big_endian),
             number_at(index, i * kPlaceBytes + kNumberBytes, sharding.index_big_endian)};
    if (!place.stored()) continue;
    if (place.offset > shard_bytes || place.bytes > shard_bytes - place.offset) {
      throw input_error(where, cat("chunk ", i, " of the shard is said to have ", place.bytes, " bytes at ",
                                   place.offset, ", and the shard has ", shard_bytes, " bytes; the file is damaged"));
    }
    if (place.offset < index_end && place.offset + place.bytes > index_begin) {
      throw input_error(
          where, cat("chunk ", i, " of the shard is said to have ", place.bytes, " bytes at ", place.offset,
                     ", and the shard's index lies from ", index_begin, " to ", index_end, "; the file is damaged"));
    }
  }
  return places;
}

}  // namespace weir
