// How much memory the current device has left.
#pragma once

#include <cstdint>

namespace weir {

/// Left for pictures, environments and other programs.
inline constexpr std::uint64_t kSpareDeviceBytes = 512ULL << 20U;

/// Bytes free on the current device. Where they are fewer than `wanted`, its memory pool first gives back what it keeps
/// for reuse, once the device's work is done.
std::uint64_t free_device_bytes(std::uint64_t wanted);

/// All bytes of the current device.
std::uint64_t device_bytes();

}  // namespace weir
