// One axis of a volume that is sampled: how it is cut into cells, and which of them are taken.
#pragma once

#include <cstdint>

namespace weir {

/// Lengths and positions in voxels, unless they say leaves. A cell is a whole number of leaves, and of chunks where the
/// volume has some that begin where leaves do.
class SampleAxis {
 public:
  /// Of the domain [lo, hi), hi > lo. `chunk` is 0 where there is none, `chunk_edge` the index of any chunk's edge.
  /// Without chunks a cell has at most `longest` leaves. Cells begin at multiples of `brick` leaves. All are taken.
  SampleAxis(std::int64_t lo, std::int64_t hi, std::int64_t chunk, std::int64_t chunk_edge, std::int64_t longest,
             std::int64_t brick);

  /// All of the axis is taken, with what lies before its first cell and after its last one.
  bool whole() const { return taken_ == cells_; }
  std::int64_t lo() const { return lo_; }
  std::int64_t hi() const { return hi_; }
  std::int64_t cell() const { return cell_; }
  std::int64_t taken() const { return taken_; }
  /// Of the part of the axis that one taken cell stands for.
  std::int64_t span() const { return (hi_ - lo_) / taken_; }
  /// That are taken.
  std::int64_t voxels() const { return whole() ? hi_ - lo_ : taken_ * cell_; }
  /// Whether as few cells are taken as make a lower node.
  bool narrow() const;

  /// Takes fewer: the next number of cells that make whole lower nodes, or else half of them. Not where one is taken.
  void take_fewer();

  /// Where the cell begins that is taken from the stratum at that place, one of taken() equal parts of the axis;
  /// `fraction`, from 0 to below 1, says where in it. Each cell is as likely as any other.
  std::int64_t begin(std::int64_t stratum, double fraction) const;

 private:
  std::int64_t lo_;
  std::int64_t hi_;
  std::int64_t first_;  // where the first cell begins
  std::int64_t cell_;
  std::int64_t cells_ = 1;  // at least 1
  std::int64_t taken_ = 1;  // 1 to cells_
};

}  // namespace weir
