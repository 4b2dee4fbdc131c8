// Vectors whose components are volumes of their own, one behind the other, as voxels of several numbers.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "ingest/hdf5/storage/stored_boxes.h"

namespace weir {

/// Boxes of `parts.size()` numbers a voxel, side by side, the one at i from parts[i]: parts of the same chunks, one or
/// more, of `value_bytes` a number. Each part is read once for each box.
std::unique_ptr<StoredBoxes> make_planar_boxes(std::vector<std::unique_ptr<StoredBoxes>> parts,
                                               std::size_t value_bytes);

}  // namespace weir
