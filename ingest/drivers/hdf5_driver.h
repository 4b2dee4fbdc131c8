// Reads HDF5 files through the driver weir_hdf5.so.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ingest/drivers/hdf5_crash.h"
#include "ingest/source/dataset_info.h"
#include "ingest/source/source_options.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// The functions of weir_hdf5.so, which ingest/hdf5/hdf5_source.h declares.
struct Hdf5Driver {
  std::unique_ptr<VolumeSource> (*open)(const std::string& path, const SourceOptions& options);
  std::vector<DatasetInfo> (*list)(const std::string& path, const SourceOptions& options);
  const Hdf5Reads* reads;
};

/// Open or list the HDF5 file `path` with the driver. Throw Error(io) if the driver cannot be loaded (load_driver).
std::unique_ptr<VolumeSource> open_by_hdf5_driver(const std::string& path, const SourceOptions& options);
std::vector<DatasetInfo> list_by_hdf5_driver(const std::string& path, const SourceOptions& options);

}  // namespace weir
