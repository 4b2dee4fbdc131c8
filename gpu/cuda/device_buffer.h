// The device memory that a grid is loaded into, kept from one load to the next.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "gpu/cuda/load/direct_storage.h"
#include "gpu/cuda/load/pinned_ring.h"
#include "gpu/cuda/runtime/device_array.h"

namespace weir {

/// Grows if a grid needs more. If the files of a series have one size, two buffers play it without further
/// allocations. The buffer also keeps what a slower way of loading had to set up. Move only; serves one load at a
/// time.
class DeviceBuffer {
 public:
  DeviceBuffer() = default;

  std::byte* data() const { return memory_.data(); }
  std::uint64_t capacity() const { return memory_.bytes(); }

  /// Makes the buffer at least `bytes` large, rounded up to a multiple of 16. If it grows, its content is lost.
  /// Throws Error(io) if the device has no room; the buffer is empty then.
  void reserve(std::uint64_t bytes) {
    if (bytes <= capacity()) return;
    memory_ = DeviceArray<std::byte>();  // freed first: there may be no room for both
    memory_ = DeviceArray<std::byte>((bytes + 15) / 16 * 16);
  }

  /// Gives the memory back if it is more than an eighth larger than `bytes`.
  void shrink_to(std::uint64_t bytes) {
    if (capacity() > bytes + bytes / 8) memory_ = DeviceArray<std::byte>();
  }

  std::optional<PinnedRing>& ring() { return ring_; }
  std::optional<DirectStorage>& direct_storage() { return direct_storage_; }

 private:
  DeviceArray<std::byte> memory_;
  std::optional<PinnedRing> ring_;
  std::optional<DirectStorage> direct_storage_;
};

}  // namespace weir
