#include "format/layout/tree_layout.h"

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {
namespace {

constexpr std::uint64_t align(std::uint64_t offset) {
  return (offset + nvdb::kAlignment - 1) / nvdb::kAlignment * nvdb::kAlignment;
}

constexpr std::uint64_t kMost = 0xFFFFFFFFULL;

}  // namespace

bool countable(const NodeCounts& counts) { return counts.leaves <= kMost && counts.leaf_tiles <= kMost; }

void check_countable(const NodeCounts& counts, const std::string& path) {
  if (countable(counts)) return;
  throw Error(ErrorKind::budget, cat(path, ": the grid would have ", counts.leaves, " leaves and ", counts.leaf_tiles,
                                     " tiles of 8^3 voxels, NanoVDB counts up to ", kMost,
                                     " of each; ask for a smaller size or a larger error"));
}

TreeLayout make_layout(const NodeCounts& counts) {
  TreeLayout layout;
  layout.counts = counts;
  layout.grid = nvdb::kPage;  // the name field is padded up to it
  layout.uppers = layout.grid + nvdb::kRootTilesOffset + counts.root_tiles * nvdb::kRootTileBytes;
  layout.lowers = layout.uppers + counts.uppers * nvdb::kUpperBytes;
  layout.leaves = layout.lowers + counts.lowers * nvdb::kLowerBytes;
  layout.blind_meta = layout.leaves + counts.leaf_bytes;
  layout.blind_data = layout.blind_meta + layout.blind_records() * nvdb::kBlindMetaBytes;
  layout.packed_data = layout.blind_data + counts.macrocells * 2 * sizeof(float);
  layout.content_end = counts.packed_bytes > 0 ? layout.packed_data + counts.packed_bytes : align(layout.packed_data);
  layout.file_bytes = layout.content_end;
  return layout;
}

TreeLayout padded_to(TreeLayout layout, std::uint64_t file_bytes) {
  if (file_bytes < layout.content_end) {
    throw Error(ErrorKind::internal, cat("layout of ", layout.content_end, " bytes does not fit ", file_bytes));
  }
  layout.file_bytes = file_bytes;
  return layout;
}

}  // namespace weir
