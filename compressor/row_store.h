// The survey's rows, one per leaf of the lattice, in a spill file: 48 bytes a
// leaf in linear order (x fastest), so that 10^12 voxels are a matter of disk.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "compressor/leaf_row.h"
#include "format/file_system.h"
#include "format/index.h"

namespace weir {

/// Thread-safe: positioned reads and writes only.
class RowStore {
 public:
  /// Reserves the rows of `leaves` (a lattice of dim 8) in `file`; a full disk is known here. A walk over
  /// regions holds the rows of up to `segment_regions` of them per thread.
  RowStore(std::unique_ptr<File> file, const NodeLattice& leaves, std::int64_t segment_regions);

  const NodeLattice& leaves() const { return leaves_; }
  std::int64_t segment_regions() const { return segment_regions_; }

  /// `rows` of consecutive leaves, from linear index `first` on.
  void write(std::int64_t first, std::span<const LeafRow> rows);
  void read(std::int64_t first, std::span<LeafRow> rows) const;
  /// Rows of the leaves in `box` (lattice positions), x fastest.
  void read_box(const Box& box, std::vector<LeafRow>& rows) const;

 private:
  std::unique_ptr<File> file_;
  NodeLattice leaves_;
  std::int64_t segment_regions_;
};

}  // namespace weir
