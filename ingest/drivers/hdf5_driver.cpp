#include "ingest/drivers/hdf5_driver.h"

#include "ingest/drivers/driver.h"
#include "ingest/drivers/hdf5_crash.h"

namespace weir {
namespace {

const Hdf5Driver& driver_for(const std::string& path) {
  const Hdf5Driver& driver = *static_cast<const Hdf5Driver*>(load_driver("hdf5", path + ": is an HDF5 file"));
  watch_hdf5_reads(*driver.reads);
  return driver;
}

}  // namespace

std::unique_ptr<VolumeSource> open_by_hdf5_driver(const std::string& path, const SourceOptions& options) {
  const Hdf5Driver& driver = driver_for(path);
  const Hdf5Call call(path);
  return driver.open(path, options);
}

std::vector<DatasetInfo> list_by_hdf5_driver(const std::string& path, const SourceOptions& options) {
  const Hdf5Driver& driver = driver_for(path);
  const Hdf5Call call(path);
  return driver.list(path, options);
}

}  // namespace weir
