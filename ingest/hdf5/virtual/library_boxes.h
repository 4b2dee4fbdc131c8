// Boxes by the library's own H5Dread: for filters that only its plugins undo,
// for compact datasets, those in external files, and those with a time between the axes of space.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ingest/hdf5/file/hdf5_handle.h"
#include "ingest/hdf5/storage/storage.h"
#include "ingest/hdf5/storage/stored_boxes.h"

namespace weir {

/// Where a volume lies in an array.
struct ArrayPlace {
  std::array<std::size_t, 3> axes;  ///< of z, y and x, 0 the slowest
  std::vector<std::int64_t> index;  ///< one position for each other axis, but for a last one of components

  /// The three axes behind those of `index`.
  static ArrayPlace behind(std::vector<std::int64_t> index);
};

/// Selects `box` (voxels) of `place` in a copy of `space`, which has an axis for each of its axes and positions; or one
/// more, whose last axis has the components of each voxel and is selected whole. The caller holds Hdf5Lock.
Hdf5Handle select_box(hid_t space, const ArrayPlace& place, const Box& box);

/// The volume at `place` of `dataset`; voxels as select_box selects them. Messages begin with `where`.
std::unique_ptr<StoredBoxes> make_library_boxes(Hdf5Handle dataset, const Storage& storage, ArrayPlace place,
                                                const std::string& where);

}  // namespace weir
