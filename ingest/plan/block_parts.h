// A block that is read in parts, with one value for all voxels of a group (VolumeSource::repeated_parts).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "format/base/index.h"
#include "ingest/source/repeated_part.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// The layout of a block's values: the values of its parts follow each other.
class BlockParts {
 public:
  /// `parts` are the parts of the box `voxels`.
  BlockParts(std::vector<RepeatedPart> parts, const Box& voxels);

  /// Reads all parts to the front of `values`, which has room for all voxels of the block.
  ConversionLoss read(VolumeSource& source, std::span<float> values) const;

  /// Collects the values of one leaf, or of its voxels that lie in the block, out of the block's `values`. Writes one
  /// value per group to the front of `distinct`, x fastest. Returns how many voxels share a value along each axis.
  Index3 gather(std::span<const float> values, const Box& leaf, std::span<float> distinct) const;

 private:
  /// Where the values of one part lie.
  struct Place {
    std::size_t first;  ///< first value of the part
    Index3 groups;
    Index3 shift;  ///< a group is 1 << shift voxels along an axis
  };
  std::vector<RepeatedPart> parts_;
  std::vector<Place> places_;
  Box leaves_;
  std::vector<std::uint32_t> part_of_;  ///< index of each leaf's part, x fastest
};

/// Writes each value of `distinct`, one per group of `by` voxels, x fastest, to all voxels of its group in `values`,
/// which has `extent` voxels.
void repeat_values(const float* distinct, const Index3& by, const Index3& extent, float* values);

}  // namespace weir
