// HDF5 files, NetCDF-4 among them, as sources.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ingest/source/dataset_info.h"
#include "ingest/source/source_options.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Opens options.dataset of `path` (the only one that can be converted where it is empty), at options.index of
/// its leading axes. x is the array's last axis, or the one before an axis of components (options.component).
/// Contiguous values are read as raw ones, chunks decoded in parallel where weir has their filters
/// (ingest/hdf5/storage/chunk_reader.h), all else by the library. Chunks that were never written read as the dataset's
/// fill value. Throws Error(input) where the file, the dataset or its values cannot be read, and Error(usage) where the
/// choice among several is open or the index does not fit.
std::unique_ptr<VolumeSource> open_hdf5(const std::string& path, const SourceOptions& options);

/// Every dataset, and every constant component of openPMD; dimensions of NetCDF without coordinates are left out.
std::vector<DatasetInfo> list_hdf5(const std::string& path, const SourceOptions& options);

}  // namespace weir
