// HDF5 files through weir_hdf5.so.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ingest/drivers/hdf5_crash.h"
#include "ingest/source/dataset_info.h"
#include "ingest/source/source_options.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// What weir_hdf5.so does: ingest/hdf5/hdf5_source.h.
struct Hdf5Driver {
  std::unique_ptr<VolumeSource> (*open)(const std::string& path, const SourceOptions& options);
  std::vector<DatasetInfo> (*list)(const std::string& path, const SourceOptions& options);
  const Hdf5Reads* reads;
};

/// The functions of the driver for the HDF5 file `path`. Throw Error(io) where there is no driver (load_driver).
std::unique_ptr<VolumeSource> open_by_hdf5_driver(const std::string& path, const SourceOptions& options);
std::vector<DatasetInfo> list_by_hdf5_driver(const std::string& path, const SourceOptions& options);

}  // namespace weir
