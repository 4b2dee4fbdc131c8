// The entry point of weir_hdf5.so.
#include "ingest/drivers/driver.h"
#include "ingest/drivers/hdf5_driver.h"
#include "ingest/hdf5/file/hdf5_lock.h"
#include "ingest/hdf5/hdf5_source.h"

WEIR_DRIVER_ENTRY;
WEIR_DRIVER_ENTRY {
  static const weir::Hdf5Driver kDriver{weir::open_hdf5, weir::list_hdf5, &weir::hdf5_reads()};
  return &kDriver;
}
