// Reads boxes with the library's own H5Dread: filters that only its plugins undo, compact datasets, datasets that were
// never written, components one behind the other, and a time axis between or after the axes of space.
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

/// The position of a volume in an array.
struct ArrayPlace {
  std::array<std::size_t, 3> axes;  ///< of z, y and x, 0 the slowest
  std::vector<std::int64_t> index;  ///< one position for each other axis, except a last axis of components

  /// Returns the place on the three axes after the axes of `index`.
  static ArrayPlace behind(std::vector<std::int64_t> index);
};

/// Selects `box` (voxels) of `place` in a copy of `space`. `space` has one axis for each axis and position of
/// `place`. It may have one more, last axis with the components of each voxel, which is selected whole. The caller
/// holds Hdf5Lock.
Hdf5Handle select_box(hid_t space, const ArrayPlace& place, const Box& box);

/// Returns the volume at `place` of `dataset`, with voxels as select_box() selects them. Messages begin with `where`.
std::unique_ptr<StoredBoxes> make_library_boxes(Hdf5Handle dataset, const Storage& storage, ArrayPlace place,
                                                const std::string& where);

}  // namespace weir
