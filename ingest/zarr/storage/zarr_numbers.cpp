#include "ingest/zarr/storage/zarr_numbers.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "ingest/axes/space_axis.h"
#include "ingest/chunks/chunk_scratch.h"
#include "ingest/values/decode_doubles.h"
#include "ingest/zarr/codecs/codec_chain.h"
#include "ingest/zarr/storage/zarr_chunks.h"

namespace weir {
namespace {

constexpr std::uint64_t kIndexMemory = std::uint64_t{128} << 20U;  ///< a shard index may take a sixteenth of it

void add_axes_in_front(std::size_t count, std::vector<std::int64_t>& elements) {
  elements.insert(elements.begin(), count, 1);
}

/// Returns the array as a volume, which the chunk readers need: with leading axes of one element that its keys do not
/// name.
ZarrArray as_volume(ZarrArray array) {
  const std::size_t missing = kSpaceAxes - array.shape.size();
  add_axes_in_front(missing, array.shape);
  add_axes_in_front(missing, array.chunk);
  array.codecs.transpose.clear();  // a single axis has only one order
  for (ZarrSharding& shard : array.shards) {
    add_axes_in_front(missing, shard.chunk);
    shard.codecs.transpose.clear();
  }
  array.axis_names.insert(array.axis_names.begin(), missing, std::string());
  array.keys.unnamed = missing;
  return array;
}

}  // namespace

std::vector<double> zarr_numbers(ZarrStore& store, const std::string& key, ZarrArray array,
                                 const ValueMapping& mapping) {
  const ZarrArray volume = as_volume(std::move(array));
  const std::string where = store.shown(key);
  const ChunkGeometry geometry(volume, {}, where);
  const ScratchSize size = scratch_size(volume.values(), geometry.unit_shape().bytes());
  ZarrChunks chunks({store, key, volume.keys}, volume, geometry, kIndexMemory, nullptr);
  ChunkScratch scratch(size.buffer_bytes, size.two);
  const auto decoded = [&](std::span<const std::byte> bytes) {
    return decode_doubles(bytes, volume.type, volume.values().big_endian, mapping);
  };
  std::vector<double> numbers;
  const auto count = static_cast<std::size_t>(geometry.extent().x);
  for (std::int64_t chunk = 0; numbers.size() < count; ++chunk) {
    const std::size_t here = std::min(static_cast<std::size_t>(geometry.unit().x), count - numbers.size());
    const std::span<const std::byte> bytes = chunks.decode({chunk, 0, 0}, scratch);
    if (!bytes.empty()) {
      const std::vector<double> read = decoded(bytes.first(here * geometry.unit_shape().value_bytes));
      numbers.insert(numbers.end(), read.begin(), read.end());
    } else {
      numbers.resize(numbers.size() + here, volume.fill ? decoded(*volume.fill).front() : std::nan(""));
    }
  }
  return numbers;
}

}  // namespace weir
