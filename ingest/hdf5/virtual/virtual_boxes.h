// Boxes of a virtual dataset, each read from the datasets it is mapped to.
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
  Uncovered unmapped;  ///< elements of those voxels without a source, which read as the dataset's fill value
  UnwrittenInSources unwritten;
};

/// Of a volume, what is read; a region may lie where there are no sources.
struct WantedVoxels {
  Box box;
  bool need_a_source = true;
};

/// The three axes of `dataset` (in the file `parent`) behind the leading ones, at `index`, one position per leading
/// axis; of several `components` a voxel these are the last axis. Only boxes inside `wanted` are read: sources of
/// others are not looked at. Throws what virtual_mappings throws. The caller holds Hdf5Lock.
VirtualVolume make_virtual_boxes(Hdf5Handle dataset, std::vector<std::int64_t> index, const WantedVoxels& wanted,
                                 std::int64_t components, const std::string& parent, const std::string& where);

}  // namespace weir
