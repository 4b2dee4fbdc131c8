// What the survey says of the leaves that the encode pass comes to. Their digests are held against what it reads: of a
// source that changed in between, one would certify the other's values.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "compressor/row_store.h"
#include "format/digest.h"
#include "format/index.h"
#include "ingest/volume_source.h"

namespace weir {

/// Of a box of leaves, 40 bytes each. Thread-safe.
class SurveyedLeaves {
 public:
  /// `leaf_box`: lattice positions. `info`, of the source, must outlive the object.
  SurveyedLeaves(const RowStore& rows, const Box& leaf_box, const SourceInfo& info);

  /// Throws Error(input) where the in-domain values of `leaf` (a lattice position in the box) are not those that were
  /// surveyed. `values`, x fastest, are those over `voxels`, which hold the leaf's. Costs about 0.2 us.
  void check(const Index3& leaf, std::span<const float> values, const Box& voxels) const;

  /// The least squared error estimated for `leaf` at less than 1 << bits_log2 bits; infinite where there is no
  /// estimate.
  double narrower_error(const Index3& leaf, unsigned bits_log2) const;

 private:
  [[noreturn]] void fail(const Box& inside) const;

  const NodeLattice& leaves_;
  Box leaf_box_;
  struct Leaf {
    Digest digest;
    std::array<double, 3> narrower_errors;  // at less than 2, 4, and 8 or more bits
  };
  const Leaf& at(const Index3& leaf) const;

  std::vector<Leaf> surveyed_;
  const SourceInfo& info_;
};

}  // namespace weir
