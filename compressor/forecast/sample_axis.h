// One axis of a sampled volume: how the axis is cut into cells, and which cells are taken.
#pragma once

#include <cstdint>

namespace weir {

/// Lengths and positions are in voxels unless they say leaves. A cell is a whole number of leaves. If the volume has
/// chunks that begin where leaves begin, a cell is also a whole number of chunks.
class SampleAxis {
 public:
  /// Cuts the domain [lo, hi), hi > lo, into cells and takes all of them. `chunk` is the length of a chunk, or 0
  /// without chunks; `chunk_edge` is the index of any chunk's edge. Without chunks a cell has at most `longest` leaves.
  /// Cells begin at multiples of `brick` leaves.
  SampleAxis(std::int64_t lo, std::int64_t hi, std::int64_t chunk, std::int64_t chunk_edge, std::int64_t longest,
             std::int64_t brick);

  /// Returns whether the whole axis is taken, including the voxels before the first cell and after the last one.
  bool whole() const { return taken_ == cells_; }
  std::int64_t lo() const { return lo_; }
  std::int64_t hi() const { return hi_; }
  std::int64_t cell() const { return cell_; }
  std::int64_t taken() const { return taken_; }
  /// Returns the length of the part of the axis that one taken cell stands for.
  std::int64_t span() const { return (hi_ - lo_) / taken_; }
  /// Returns the number of voxels that are taken.
  std::int64_t voxels() const { return whole() ? hi_ - lo_ : taken_ * cell_; }
  /// Returns whether only one cell is taken, or no more cells than make one lower node.
  bool narrow() const;

  /// Takes fewer cells: the next smaller number that makes whole lower nodes, otherwise half of them. Do not call it if
  /// only one cell is taken.
  void take_fewer();

  /// Returns where the cell begins that is taken from `stratum`, one of taken() equal parts of the axis. `fraction`,
  /// from 0 to below 1, chooses the cell in the stratum. Each cell is equally likely.
  std::int64_t begin(std::int64_t stratum, double fraction) const;

 private:
  std::int64_t lo_;
  std::int64_t hi_;
  std::int64_t first_;  // begin of the first cell
  std::int64_t cell_;
  std::int64_t cells_ = 1;  // at least 1
  std::int64_t taken_ = 1;  // 1 to cells_
};

}  // namespace weir
