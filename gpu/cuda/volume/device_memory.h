// How much memory a device has left, and how much of it is kept for reuse.
#pragma once

#include <cstdint>

namespace weir {

/// Bytes left for pictures, environments and other programs.
inline constexpr std::uint64_t kSpareDeviceBytes = 512ULL << 20U;

/// Returns the bytes that are free on the current device. If they are fewer than `wanted`, its memory pool first
/// gives back what it keeps for reuse, after the device's work has ended.
std::uint64_t free_device_bytes(std::uint64_t wanted);

/// Returns the total bytes of the current device.
std::uint64_t device_bytes();

/// While an object of a device lives, the device's default memory pool keeps freed memory for the next allocations.
/// After the last object the pool has its old threshold again and gives back what exceeds it, because the whole
/// program shares the pool.
class KeptMemory {
 public:
  explicit KeptMemory(int device);
  ~KeptMemory();
  KeptMemory(const KeptMemory&) = delete;
  KeptMemory& operator=(const KeptMemory&) = delete;

 private:
  int device_;
};

}  // namespace weir
