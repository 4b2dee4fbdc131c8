// A dense array in the memory of a CUDA device, as a source: boxes of it cross the bus when they are read, as they are
// stored.
#pragma once

#include <memory>

#include "ingest/values/array_source.h"

namespace weir {

/// The device that can read `address`. Throws Error(usage) where it is no memory of a device, or there is none.
int device_of(const void* address);

/// A source that reads `array`, whose data lie on `device`, which have been computed and must stay unchanged for as
/// long as the source exists. Whichever thread reads it works in the calling thread's context, where that is of
/// `device`. Page-locked host memory that it takes is that of DeviceSlabs, where no row is longer than a piece. Throws
/// what array_info throws, Error(usage) where the address or a stride is no multiple of the bytes of a value, and
/// Error(io) where there is no memory to lock.
std::unique_ptr<VolumeSource> open_device_array(const DenseArray& array, int device);

}  // namespace weir
