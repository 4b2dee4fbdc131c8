#include "ingest/plan/box_pieces.h"

#include <algorithm>

namespace weir {

BoxPieces::BoxPieces(const Index3& extent, const Box& box, std::size_t voxel_bytes, std::uint64_t header_bytes,
                     std::uint64_t piece_bytes)
    : voxel_bytes_(voxel_bytes),
      offset_(header_bytes + static_cast<std::uint64_t>(linear_index(box.lo, extent)) * voxel_bytes) {
  const Index3 e = box.extent();
  const std::uint64_t row_bytes = static_cast<std::uint64_t>(extent.x) * voxel_bytes;
  const std::uint64_t plane_bytes = static_cast<std::uint64_t>(extent.y) * row_bytes;
  if (e.x == extent.x && e.y == extent.y) {
    run_voxels_ = volume(e);
  } else if (e.x == extent.x) {
    run_voxels_ = e.x * e.y;
    inner_count_ = e.z;
    inner_stride_ = plane_bytes;
  } else {
    run_voxels_ = e.x;
    inner_count_ = e.y;
    inner_stride_ = row_bytes;
    outer_count_ = e.z;
    outer_stride_ = plane_bytes;
  }

  const std::uint64_t run_bytes = static_cast<std::uint64_t>(run_voxels_) * voxel_bytes;
  voxels_per_piece_ = run_voxels_;
  if (run_bytes > piece_bytes) {
    voxels_per_piece_ = static_cast<std::int64_t>(piece_bytes / voxel_bytes);
    parts_per_run_ = ceil_div(run_voxels_, voxels_per_piece_);
  } else if (inner_count_ > 1 && inner_stride_ - run_bytes <= kMaxGapBytes) {
    const auto fitting = 1 + static_cast<std::int64_t>((piece_bytes - run_bytes) / inner_stride_);
    runs_per_piece_ = std::min(fitting, inner_count_);
  }
  pieces_per_outer_ = ceil_div(inner_count_, runs_per_piece_) * parts_per_run_;
}

BoxPiece BoxPieces::piece(std::int64_t i) const {
  const std::int64_t outer = i / pieces_per_outer_;
  const std::int64_t group = i % pieces_per_outer_ / parts_per_run_;
  const std::int64_t part = i % parts_per_run_;
  const std::int64_t inner = group * runs_per_piece_;
  const std::int64_t start = part * voxels_per_piece_;

  BoxPiece piece;
  piece.runs = std::min(runs_per_piece_, inner_count_ - inner);
  piece.run_voxels = std::min(voxels_per_piece_, run_voxels_ - start);
  piece.first_value = (outer * inner_count_ + inner) * run_voxels_ + start;
  piece.stride_bytes = inner_stride_;
  piece.offset = offset_ + static_cast<std::uint64_t>(outer) * outer_stride_ +
                 static_cast<std::uint64_t>(inner) * inner_stride_ + static_cast<std::uint64_t>(start) * voxel_bytes_;
  piece.bytes = static_cast<std::uint64_t>(piece.runs - 1) * inner_stride_ +
                static_cast<std::uint64_t>(piece.run_voxels) * voxel_bytes_;
  return piece;
}

}  // namespace weir
