#include "compressor/survey/surveyed_leaves.h"

#include <array>

#include "compressor/leaf/leaf_in_block.h"
#include "format/base/text.h"
#include "ingest/files/file_state.h"
#include "ingest/source/extent.h"

namespace weir {

SurveyedLeaves::SurveyedLeaves(const RowStore& rows, const Box& leaf_box, const SourceInfo& info, bool read)
    : leaves_(rows.leaves()), leaf_box_(leaf_box), info_(info) {
  if (!read) return;
  held_ = rows.held();
  if (held_ != nullptr) return;
  std::vector<LeafRow> layer;  // only one layer at a time, because a row is larger than a digest
  digests_.reserve(static_cast<std::size_t>(leaf_box.voxels()));
  for (std::int64_t z = leaf_box.lo.z; z < leaf_box.hi.z; ++z) {
    const Box box{{leaf_box.lo.x, leaf_box.lo.y, z}, {leaf_box.hi.x, leaf_box.hi.y, z + 1}};
    rows.read_box(box, layer);
    for (const LeafRow& row : layer) digests_.push_back(row.digest);
  }
}

void SurveyedLeaves::check(const Index3& leaf, std::span<const float> values, const Box& voxels) const {
  if (!checks()) return;
  const Box inside = leaves_.voxels(leaf);
  const Index3 rows = voxels.extent();
  if (held_ != nullptr) __builtin_prefetch(held_ + leaves_.linear(leaf));
  // Leaves come along z, so the next leaf's rows of voxels are prefetched if `voxels` contains that leaf.
  const std::int64_t next = inside.hi.z + kLeafDim <= voxels.hi.z ? kLeafDim * rows.x * rows.y : 0;
  std::array<float, kLeafVoxels> own;
  check(leaf, leaf_digest(copy_leaf(values, voxels, inside, next, own)));
}

void SurveyedLeaves::prefetch_layer(std::int64_t x) const {
  if (held_ == nullptr) return;
  for (std::int64_t y = leaf_box_.lo.y; y < leaf_box_.hi.y; ++y) {
    for (std::int64_t z = leaf_box_.lo.z; z < leaf_box_.hi.z; ++z) {
      __builtin_prefetch(held_ + leaves_.linear({x, y, z}));
    }
  }
}

void SurveyedLeaves::check(const Index3& leaf, const Digest& digest) const {
  if (!checks()) return;
  const Digest& surveyed =
      held_ != nullptr ? held_[leaves_.linear(leaf)].digest
                       : digests_[static_cast<std::size_t>(linear_index(leaf - leaf_box_.lo, leaf_box_.extent()))];
  if (digest != surveyed) fail(leaves_.voxels(leaf));
}

void SurveyedLeaves::fail(const Box& inside) const {
  check_unchanged(info_.files);
  throw changed_error(info_.path, cat("voxels ", box_text(inside), " have other values than a moment ago"));
}

}  // namespace weir
