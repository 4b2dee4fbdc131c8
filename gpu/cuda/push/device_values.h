// Values in the memory of a device that a caller gives: where they are, and whether they can be taken as they are.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "format/base/index.h"

namespace weir {

/// Where values are that the current device can read.
struct DeviceValues {
  const std::byte* first;              ///< voxel (0, 0, 0), a multiple of value_bytes
  std::array<std::int64_t, 3> stride;  ///< bytes from one voxel to the next along x, y, z: multiples of value_bytes
  std::size_t value_bytes;             ///< 1, 2, 4 or 8
};

/// Whether they are planes of `extent` values, x fastest and without gaps.
bool without_gaps(const DeviceValues& values, const Index3& extent);

/// Throws Error(usage) where the address or a stride is no multiple of the value's bytes, or another device than
/// `device`, which the first slab came from, is current.
void check_slab(const DeviceValues& values, int device);

struct DevicePlace {
  int device;
  bool managed;  ///< other devices can read it, too
};

/// Throws Error(usage) where a kernel of the current device would have to read `values`, planes of `extent`, of another
/// device, with access to it or without: it would break the context of a program that has not enabled that.
void check_reach(const DeviceValues& values, const Index3& extent, const DevicePlace& place);

/// Of the memory at `address`; nullopt where kernels cannot read it, which may be host memory that CUDA does not know
/// of, or where there is no device. Throws Error(io).
std::optional<DevicePlace> device_place(const void* address);

/// Whether there is a device_place() of it. Throws Error(io).
bool is_device_memory(const void* address);

/// Whether kernels of `device` can read what is at `address`, as memory of that device or managed. Throws Error(io).
bool lies_on(const void* address, int device);

}  // namespace weir
