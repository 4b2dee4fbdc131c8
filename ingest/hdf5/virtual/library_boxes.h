// Boxes by the library's own H5Dread: for filters that only its plugins undo,
// for compact datasets and those in external files.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ingest/hdf5/file/hdf5_handle.h"
#include "ingest/hdf5/storage/storage.h"
#include "ingest/hdf5/storage/stored_boxes.h"

namespace weir {

/// Selects `box` (voxels) at position `index` of the leading axes in a copy of the space of `dataset`, of rank
/// index.size() + 3. The caller holds Hdf5Lock.
Hdf5Handle select_box(hid_t space, const std::vector<std::int64_t>& index, const Box& box);

/// The last three axes of `dataset` at `index`, one position per leading axis. Messages begin with `where`.
std::unique_ptr<StoredBoxes> make_library_boxes(Hdf5Handle dataset, const Storage& storage,
                                                std::vector<std::int64_t> index, const std::string& where);

}  // namespace weir
