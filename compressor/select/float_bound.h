// What a file of float32 leaves loses at least at a size, and takes at least for an error: from one pass over the rows,
// where planning that file takes several.
#pragma once

#include <cstdint>
#include <vector>

#include "compressor/select/tree_regions.h"
#include "compressor/survey/row_store.h"

namespace weir {

/// Bounds that no choice of leaves and no value of their tiles can go below: as if nodes took no bytes, and every leaf
/// that is dropped read the mean of its values. For stores of one process.
class FloatBound {
 public:
  FloatBound(const TreeRegions& tree, const RowStore& rows);

  /// Of the squared error over the finite voxels of a file of so many bytes.
  double least_error(std::uint64_t file_bytes) const;
  /// Of the bytes of a file that loses at most `squared_error`.
  std::uint64_t least_bytes(double squared_error) const;

 private:
  // Leaves that lose about the same where they are dropped, two classes an octave.
  struct Class {
    double error = 0;  // of all of them
    std::uint64_t leaves = 0;
  };

  std::vector<Class> classes_;  // by rising error
};

}  // namespace weir
