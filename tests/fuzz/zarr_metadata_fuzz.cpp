// libFuzzer target for the metadata of Zarr. The first byte selects an array of version 2 or 3, or multiscale images.
// Any bytes must parse to metadata with consistent parts, or throw Error with a message of one line.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "format/base/error.h"
#include "ingest/zarr/meaning/array_meaning.h"
#include "ingest/zarr/meaning/multiscales.h"
#include "ingest/zarr/metadata/array_v2.h"
#include "ingest/zarr/metadata/array_v3.h"
#include "ingest/zarr/metadata/zarr_json.h"
#include "ingest/zarr/storage/chunk_geometry.h"

namespace {

void check_order(const std::vector<std::size_t>& order, std::size_t axes) {
  if (order.empty()) return;
  std::vector<std::size_t> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  if (sorted.size() != axes) std::abort();
  for (std::size_t i = 0; i < axes; ++i) {
    if (sorted[i] != i) std::abort();
  }
}

void check_array(const weir::ZarrArray& array) {
  const std::size_t axes = array.shape.size();
  if (array.chunk.size() != axes || array.unit().size() != axes || array.axis_names.size() != axes) std::abort();
  if (array.fill && array.fill->size() != weir::scalar_bytes(array.type)) std::abort();
  check_order(array.values().transpose, axes);
  for (std::size_t i = 0; i < axes; ++i) {
    if (array.chunk[i] < 1 || array.unit()[i] < 1 || array.chunk[i] % array.unit()[i] != 0) std::abort();
  }
  const weir::ArrayMeaning meaning = weir::array_meaning(array, weir::array_axes(array, std::nullopt));
  if (array.layout_text().empty() || !meaning.obstacle.empty()) return;
  const std::vector<std::int64_t> index(axes - 3, 0);
  const weir::ChunkGeometry geometry(array, index, "fuzz");
  const weir::ChunkPlace place = geometry.place_of({0, 0, 0});
  if (place.inner.size() != array.shards.size() || place.object.size() != axes) std::abort();
  for (std::size_t level = 0; level < array.shards.size(); ++level) {
    if (place.inner[level] != 0 || geometry.chunks_in_shards()[level] == 0) std::abort();
  }
  if (geometry.first_byte() != 0 || geometry.unit_shape().bytes() == 0) std::abort();
}

void check_images(const nlohmann::json& document) {
  for (const weir::Multiscale& image : weir::multiscales_in(document)) {
    if (image.levels.empty()) std::abort();
    for (const weir::ScaleLevel& level : image.levels) {
      if (level.path.empty()) std::abort();
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  try {
    const nlohmann::json document = weir::parse_zarr_json(text, "fuzz");
    if (data[0] % 3 == 0) check_array(weir::parse_zarr_v2(document, document, "fuzz"));
    if (data[0] % 3 == 1) check_array(weir::parse_zarr_v3(document, "fuzz"));
    if (data[0] % 3 == 2) check_images(document);
  } catch (const weir::Error& error) {
    if (std::string_view(error.what()).find('\n') != std::string_view::npos) std::abort();
  }
  return 0;
}
