#include "ingest/zarr/metadata/zarr_array.h"

#include <algorithm>
#include <array>

#include "format/base/text.h"

namespace weir {
namespace {

std::string extents_text(const std::vector<std::int64_t>& extents) {
  std::string text;
  for (const std::int64_t extent : extents) text += cat(text.empty() ? "" : " x ", extent);
  return text;
}

}  // namespace

std::string ZarrChunkKeys::key(std::span<const std::int64_t> position) const {
  std::string text = prefix ? "c" : "";
  for (const std::int64_t p : position.subspan(std::min(unnamed, position.size()))) {
    if (!text.empty()) text += separator;
    text += cat(p);
  }
  return text.empty() ? "0" : text;
}

std::string ZarrArray::layout_text() const {
  std::string text = cat("chunked ", extents_text(unit()));
  for (std::size_t level = shards.size(); level-- > 0;)
    text += cat(" in shards of ", extents_text(level == 0 ? chunk : shards[level - 1].chunk));
  if (!values().transpose.empty()) text += ", transposed";
  for (const ZarrFilter& filter : values().filters) text += cat(", ", filter_name(filter.kind));
  for (const ZarrPacker packer : values().packers) text += cat(", ", packer_name(packer));
  return text;
}

const char* filter_name(ZarrFilter::Kind kind) { return kind == ZarrFilter::Kind::shuffle ? "shuffle" : "delta"; }

const char* packer_name(ZarrPacker packer) {
  constexpr std::array kNames{"zlib", "gzip", "zstd", "blosc", "crc32c"};
  return kNames.at(static_cast<std::size_t>(packer));
}

}  // namespace weir
