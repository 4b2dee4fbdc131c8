// Lower bounds for a file of float32 leaves: its error at a size, and its size for an error. One pass over the rows
// finds them, while planning the file takes several passes.
#pragma once

#include <cstdint>
#include <vector>

#include "compressor/select/tree_regions.h"
#include "compressor/survey/row_store.h"

namespace weir {

/// Bounds that hold for every choice of leaves and of tile values. They are computed as if nodes took no bytes and
/// every dropped leaf read the mean of its values. For stores of one process.
class FloatBound {
 public:
  FloatBound(const TreeRegions& tree, const RowStore& rows);

  /// Returns a lower bound of the squared error over the finite voxels of a file of `file_bytes`.
  double least_error(std::uint64_t file_bytes) const;
  /// Returns a lower bound of the bytes of a file that loses at most `squared_error`.
  std::uint64_t least_bytes(double squared_error) const;

 private:
  // Leaves that lose about the same error when dropped. There are two classes an octave.
  struct Class {
    double error = 0;  // sum over the class
    std::uint64_t leaves = 0;
  };

  std::vector<Class> classes_;  // by rising error
};

}  // namespace weir
