// A box of a row-major file as a list of reads of bounded size. Pure arithmetic.
#pragma once

#include <cstddef>
#include <cstdint>

#include "format/base/index.h"

namespace weir {

/// One read: `runs` contiguous runs of voxels that begin `stride_bytes` apart in the file and follow each other in
/// the box's values.
struct BoxPiece {
  std::uint64_t offset = 0;        ///< offset of the first byte in the file
  std::uint64_t bytes = 0;         ///< from the first byte of the first run to the last byte of the last run
  std::int64_t first_value = 0;    ///< position of the first voxel in the box's values
  std::int64_t run_voxels = 0;     ///< per run
  std::int64_t runs = 1;           ///< >= 1
  std::uint64_t stride_bytes = 0;  ///< between the starts of two runs
};

/// Gaps up to this many bytes are read rather than skipped: one longer read costs less than two short reads.
inline constexpr std::uint64_t kMaxGapBytes = 16384;

/// The pieces of one box, in the order of its values; x fastest in the file and in the box.
class BoxPieces {
 public:
  /// `box` is in voxels from the first voxel of a volume of `extent` voxels of `voxel_bytes` each. The volume begins
  /// `header_bytes` into the file. `piece_bytes` >= voxel_bytes is the limit of BoxPiece::bytes.
  BoxPieces(const Index3& extent, const Box& box, std::size_t voxel_bytes, std::uint64_t header_bytes,
            std::uint64_t piece_bytes);

  std::int64_t size() const { return outer_count_ * pieces_per_outer_; }
  BoxPiece piece(std::int64_t i) const;

 private:
  std::uint64_t voxel_bytes_;
  std::uint64_t offset_;  ///< file offset of the box's first voxel
  std::int64_t run_voxels_;
  std::int64_t inner_count_ = 1;  ///< runs per outer step
  std::uint64_t inner_stride_ = 0;
  std::int64_t outer_count_ = 1;
  std::uint64_t outer_stride_ = 0;
  std::int64_t runs_per_piece_ = 1;
  std::int64_t voxels_per_piece_;  ///< of one run; equals run_voxels_ if a run is not cut
  std::int64_t parts_per_run_ = 1;
  std::int64_t pieces_per_outer_ = 1;
};

}  // namespace weir
