// HDF5 files, NetCDF-4 among them, as sources.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ingest/source/dataset_info.h"
#include "ingest/source/source_options.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Opens `options.dataset` of `path` at position `options.index` on its leading axes. If `options.dataset` is empty,
/// opens the only dataset that can be converted. x is the array's last axis, or the axis before an axis of components
/// (`options.component`). Contiguous values are read as raw values. Chunks are decoded in parallel if weir has their
/// filters (ingest/hdf5/storage/chunk_reader.h). The library reads everything else. Chunks that were never written
/// read as the dataset's fill value. Throws Error(input) if the file, the dataset or its values cannot be read, and
/// Error(usage) if several datasets are possible or the index does not fit.
std::unique_ptr<VolumeSource> open_hdf5(const std::string& path, const SourceOptions& options);

/// Lists every dataset and every constant openPMD component. Leaves out NetCDF dimensions without coordinates.
std::vector<DatasetInfo> list_hdf5(const std::string& path, const SourceOptions& options);

}  // namespace weir
