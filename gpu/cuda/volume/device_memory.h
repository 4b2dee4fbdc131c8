// How much memory the current device has left.
#pragma once

#include <cstdint>

namespace weir {

/// Bytes free on the current device. Where they are fewer than `wanted`, its memory pool first gives back what it keeps
/// for reuse, once the device's work is done.
std::uint64_t free_device_bytes(std::uint64_t wanted);

}  // namespace weir
