// Reads boxes of a virtual dataset, each from the datasets that it is mapped to.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "format/base/index.h"
#include "ingest/hdf5/file/hdf5_handle.h"
#include "ingest/hdf5/storage/stored_boxes.h"
#include "ingest/hdf5/virtual/coverage.h"
#include "ingest/hdf5/virtual/virtual_mappings.h"

namespace weir {

struct VirtualVolume {
  std::unique_ptr<StoredBoxes> boxes;
  Uncovered unmapped;  ///< elements without a source, which read as the dataset's fill value
  UnwrittenInSources unwritten;
};

/// The voxels of a volume that are read. A region may lie where the volume has no sources.
struct WantedVoxels {
  Box box;
  bool need_a_source = true;
};

/// Returns the volume on the three axes of `dataset` (in the file `parent`) after the leading axes, at `index`, one
/// position per leading axis. If voxels have several `components`, the last axis holds them. Only boxes inside
/// `wanted` may be read, because sources of other boxes are not looked at. Throws the errors of virtual_mappings().
/// The caller holds Hdf5Lock.
VirtualVolume make_virtual_boxes(Hdf5Handle dataset, std::vector<std::int64_t> index, const WantedVoxels& wanted,
                                 std::int64_t components, const std::string& parent, const std::string& where);

}  // namespace weir
