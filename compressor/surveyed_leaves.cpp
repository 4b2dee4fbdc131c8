#include "compressor/surveyed_leaves.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

#include "compressor/leaf_gain.h"
#include "format/text.h"
#include "ingest/extent.h"
#include "ingest/file_state.h"

namespace weir {

SurveyedLeaves::SurveyedLeaves(const RowStore& rows, const Box& leaf_box, const SourceInfo& info)
    : leaves_(rows.leaves()), leaf_box_(leaf_box), info_(info) {
  std::vector<LeafRow> layer;  // one at a time: a row has more bytes
  surveyed_.reserve(static_cast<std::size_t>(leaf_box.voxels()));
  for (std::int64_t z = leaf_box.lo.z; z < leaf_box.hi.z; ++z) {
    const Box box{{leaf_box.lo.x, leaf_box.lo.y, z}, {leaf_box.hi.x, leaf_box.hi.y, z + 1}};
    rows.read_box(box, layer);
    for (std::size_t i = 0; i < layer.size(); ++i) {
      const LeafRow& row = layer[i];
      Leaf leaf{row.digest, {}};
      const Index3 position = box.lo + index_at(static_cast<std::int64_t>(i), box.extent());
      leaf.narrower_errors.fill(0);  // not known: then all are tried
      if (row.finite == leaves_.voxels(position).voxels()) {
        for (unsigned log2 = 1; log2 <= leaf.narrower_errors.size(); ++log2) {
          leaf.narrower_errors[log2 - 1] = least_estimate(row, log2);
        }
      }
      surveyed_.push_back(leaf);
    }
  }
}

const SurveyedLeaves::Leaf& SurveyedLeaves::at(const Index3& leaf) const {
  return surveyed_[static_cast<std::size_t>(linear_index(leaf - leaf_box_.lo, leaf_box_.extent()))];
}

double SurveyedLeaves::narrower_error(const Index3& leaf, unsigned bits_log2) const {
  return bits_log2 == 0 ? std::numeric_limits<double>::infinity()
                        : at(leaf).narrower_errors[std::min(bits_log2, 3U) - 1];
}

void SurveyedLeaves::check(const Index3& leaf, std::span<const float> values, const Box& voxels) const {
  const Box inside = leaves_.voxels(leaf);
  const Index3 extent = inside.extent();
  const Index3 rows = voxels.extent();
  std::array<float, kLeafVoxels> own;
  float* out = own.data();
  const float* const corner = values.data() + linear_index(inside.lo - voxels.lo, rows);
  for (std::int64_t z = 0; z < extent.z; ++z) {
    for (std::int64_t y = 0; y < extent.y; ++y, out += extent.x) {
      const float* const row = corner + rows.x * (y + rows.y * z);
      if (extent.x == kLeafDim) {  // a length the compiler knows
        std::memcpy(out, row, kLeafDim * sizeof(float));
      } else {
        std::copy_n(row, extent.x, out);
      }
    }
  }
  if (leaf_digest({own.data(), static_cast<std::size_t>(volume(extent))}) != at(leaf).digest) fail(inside);
}

void SurveyedLeaves::fail(const Box& inside) const {
  check_unchanged(info_.files);
  throw changed_error(info_.path, cat("voxels ", box_text(inside), " have other values than a moment ago"));
}

}  // namespace weir
