// What the survey recorded of the leaves that the encode pass reads. Their digests are compared with what it reads: if
// the source changed in between, the certificate would be of other values than the file.
#pragma once

#include <span>
#include <vector>

#include "compressor/survey/row_store.h"
#include "format/base/index.h"
#include "format/io/digest.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Of a box of leaves, 16 bytes each where the rows do not lie in memory. Thread-safe.
class SurveyedLeaves {
 public:
  /// `leaf_box`: lattice positions. `info`, of the source, must outlive the object. `read`: whether the values are read
  /// once more; else they are those that the survey saw, and all checks hold.
  SurveyedLeaves(const RowStore& rows, const Box& leaf_box, const SourceInfo& info, bool read = true);

  /// Throws Error(input) where the in-domain values of `leaf` (a lattice position in the box) are not those that were
  /// surveyed. `values`, x fastest, are those over `voxels`, which hold the leaf's. Costs about 0.2 us.
  void check(const Index3& leaf, std::span<const float> values, const Box& voxels) const;
  /// The same by the digest of its in-domain values.
  void check(const Index3& leaf, const Digest& digest) const;
  /// Fetches what check() needs of the leaves of layer `x` of the box, whose rows do not lie together.
  void prefetch_layer(std::int64_t x) const;

 private:
  bool checks() const { return held_ != nullptr || !digests_.empty(); }
  [[noreturn]] void fail(const Box& inside) const;

  const NodeLattice& leaves_;
  Box leaf_box_;
  const LeafRow* held_ = nullptr;  // all rows of the volume, where they lie in memory
  std::vector<Digest> digests_;    // else those of the box; neither where there is nothing to check
  const SourceInfo& info_;
};

}  // namespace weir
