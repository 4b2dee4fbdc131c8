// How much memory a device has left, and what is kept of it for reuse.
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

/// As long as one of a device lives, its default memory pool keeps what it is given back for what is asked for next.
/// Then the pool is as before, and gives back what is more than that lets it keep: the pool is the whole program's.
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
