// A block whose values come in parts, one value for all voxels that repeat it (VolumeSource::repeated_parts).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "format/base/index.h"
#include "ingest/source/repeated_part.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Where the values of the parts of a block lie: one part behind the other.
class BlockParts {
 public:
  /// `parts` of the box `voxels`.
  BlockParts(std::vector<RepeatedPart> parts, const Box& voxels);

  /// Reads all parts to the front of `values`, which has room for all voxels.
  ConversionLoss read(VolumeSource& source, std::span<float> values) const;

  /// Of the voxels of one leaf, or those of them that lie in the block: the value of each group to the front of
  /// `distinct`, x fastest, out of the block's `values`. Returns how many voxels have each along the axes.
  Index3 gather(std::span<const float> values, const Box& leaf, std::span<float> distinct) const;

 private:
  /// Where the values of a part lie.
  struct Place {
    std::size_t first;  ///< of its values
    Index3 groups;
    Index3 shift;  ///< a group is 1 << shift voxels along an axis
  };
  std::vector<RepeatedPart> parts_;
  std::vector<Place> places_;
  Box leaves_;
  std::vector<std::uint32_t> part_of_;  ///< of each leaf, x fastest
};

/// Writes each of the values of groups of `by` voxels, x fastest, to all voxels of `extent` that have it.
void repeat_values(const float* distinct, const Index3& by, const Index3& extent, float* values);

}  // namespace weir
