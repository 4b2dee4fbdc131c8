// Joins vector components that are stored as separate volumes, one behind the other, into voxels of several numbers.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "ingest/hdf5/storage/stored_boxes.h"

namespace weir {

/// Returns boxes with `parts.size()` numbers for each voxel, side by side; number i comes from parts[i]. There are
/// one or more parts, all with the same chunks and `value_bytes` bytes a number. Each part is read once for each box.
std::unique_ptr<StoredBoxes> make_planar_boxes(std::vector<std::unique_ptr<StoredBoxes>> parts,
                                               std::size_t value_bytes);

}  // namespace weir
