// A dense array in the memory of a CUDA device, as a source: boxes of it cross the bus when they are read, as they are
// stored.
#pragma once

#include <memory>

#include "ingest/values/array_source.h"

namespace weir {

/// Host memory that such a source takes, page-locked, in bytes, where no row is longer than a piece.
inline constexpr std::uint64_t kDeviceArrayPiece = std::uint64_t{8} << 20U;
inline constexpr std::size_t kDeviceArrayPieces = 4;

/// The device that can read `address`. Throws Error(usage) where it is no memory of a device, or there is none.
int device_of(const void* address);

/// A source that reads `array`, whose data lie on `device`, which have been computed and must stay unchanged for as
/// long as the source exists. Throws what array_info throws, Error(usage) where the address or a stride is no multiple
/// of the bytes of a value, and Error(io) where there is no memory to lock.
std::unique_ptr<VolumeSource> open_device_array(const DenseArray& array, int device);

}  // namespace weir
