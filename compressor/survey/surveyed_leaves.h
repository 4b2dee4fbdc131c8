// Checks that the leaves that the encode pass reads have the digests that the survey recorded. If the source changed in
// between, the certificate would describe other values than the file holds.
#pragma once

#include <span>
#include <vector>

#include "compressor/survey/row_store.h"
#include "format/base/index.h"
#include "format/io/digest.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Holds the recorded digests of a box of leaves: 16 bytes per leaf if the rows do not lie in memory. Thread-safe.
class SurveyedLeaves {
 public:
  /// `leaf_box` holds lattice positions. `info` describes the source and must outlive the object. `read` says whether
  /// the values are read again. If not, they are the values that the survey saw, and every check passes.
  SurveyedLeaves(const RowStore& rows, const Box& leaf_box, const SourceInfo& info, bool read = true);

  /// Throws Error(input) if the in-domain values of `leaf` (a lattice position in the box) are not the surveyed ones.
  /// `values` are the values of the box `voxels`, x fastest, which contains the leaf. Costs about 0.2 us.
  void check(const Index3& leaf, std::span<const float> values, const Box& voxels) const;
  /// The same check, given the digest of the leaf's in-domain values.
  void check(const Index3& leaf, const Digest& digest) const;
  /// Prefetches what check() needs for the leaves with lattice position `x` in the box. Their rows do not lie together.
  void prefetch_layer(std::int64_t x) const;

 private:
  bool checks() const { return held_ != nullptr || !digests_.empty(); }
  [[noreturn]] void fail(const Box& inside) const;

  const NodeLattice& leaves_;
  Box leaf_box_;
  const LeafRow* held_ = nullptr;  // all rows of the volume, if they lie in memory
  std::vector<Digest> digests_;    // otherwise the digests of the box; both unset if nothing is checked
  const SourceInfo& info_;
};

}  // namespace weir
