// Values in device memory that a caller passes: where they are, and whether they can be used as they are.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "format/base/index.h"

namespace weir {

/// The layout of values that the current device can read.
struct DeviceValues {
  const std::byte* first;              ///< voxel (0, 0, 0), a multiple of value_bytes
  std::array<std::int64_t, 3> stride;  ///< bytes from one voxel to the next along x, y, z: multiples of value_bytes
  std::size_t value_bytes;             ///< 1, 2, 4 or 8
};

/// Returns whether `values` are planes of `extent` values, x fastest and without gaps.
bool without_gaps(const DeviceValues& values, const Index3& extent);

/// Throws Error(usage) if the address or a stride is no multiple of the value's bytes, or if the current device is
/// not `device`, which the first slab came from.
void check_slab(const DeviceValues& values, int device);

struct DevicePlace {
  int device;
  bool managed;  ///< other devices can read it as well
};

/// Throws Error(usage) if a kernel of the current device would have to read `values`, planes of `extent`, from
/// another device, with or without access to it: this would break the context of a program that has not enabled the
/// access.
void check_reach(const DeviceValues& values, const Index3& extent, const DevicePlace& place);

/// Returns where the memory at `address` is. Returns nullopt if kernels cannot read it: CUDA may not know this host
/// memory, or there may be no device. Throws Error(io).
std::optional<DevicePlace> device_place(const void* address);

/// Returns whether device_place() finds the memory. Throws Error(io).
bool is_device_memory(const void* address);

/// Returns whether kernels of `device` can read the memory at `address`, because it is that device's or managed.
/// Throws Error(io).
bool lies_on(const void* address, int device);

}  // namespace weir
