// Boxes of a virtual dataset, each read from the datasets it is mapped to.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "format/base/index.h"
#include "ingest/hdf5/file/hdf5_handle.h"
#include "ingest/hdf5/storage/stored_boxes.h"

namespace weir {

/// The last three axes of `dataset` (in the file `parent`), `extent` voxels, at `index`, one position per
/// leading axis. Throws what virtual_mappings throws. The caller holds Hdf5Lock.
std::unique_ptr<StoredBoxes> make_virtual_boxes(Hdf5Handle dataset, std::vector<std::int64_t> index,
                                                const Index3& extent, const std::string& parent,
                                                const std::string& where);

}  // namespace weir
