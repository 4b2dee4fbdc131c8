// A dense array in the memory of a CUDA device, as a source: a box crosses the bus, in the stored type, when it is
// read.
#pragma once

#include <memory>

#include "ingest/values/array_source.h"

namespace weir {

/// Returns the device that can read `address`. Throws Error(usage) if it is not memory of a device, or if there is
/// none.
int device_of(const void* address);

/// Returns a source that reads `array`. Its data lie on `device`, are complete, and must not change while the source
/// exists. Threads that read it work in the calling thread's context if that belongs to `device`. It locks host memory
/// of its own: as much as DeviceSlabs does, or more if a row is longer than a piece. Throws as array_info(),
/// Error(usage) if the address or a stride is not a multiple of the bytes of a value, and Error(io) if there is no
/// memory to lock.
std::unique_ptr<VolumeSource> open_device_array(const DenseArray& array, int device);

}  // namespace weir
