// A grid's bytes in memory that a device reads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "gpu/cuda/grid_loader.h"

namespace weir {

/// Loaded from the grid's file, or copied from another device.
class GridBytes {
 public:
  explicit GridBytes(DeviceGrid loaded) : loaded_(std::move(loaded)) {}
  /// Copies from `other_device` to `device`, the current one.
  GridBytes(const GridBytes& other, int other_device, int device)
      : copy_((other.bytes() + 15) / 16 * 16), bytes_(other.bytes()) {
    check_cuda(cudaMemcpyPeer(copy_.data(), device, other.data(), other_device, other.bytes()),
               "copying a grid to another device");
  }

  const std::byte* data() const { return loaded_ ? loaded_->data() : copy_.data(); }
  std::uint64_t bytes() const { return loaded_ ? loaded_->bytes() : bytes_; }
  /// Returns the bytes of device memory. A buffer that is larger than the grid counts in full; 0 if the bytes are in
  /// host memory.
  std::uint64_t device_bytes() const { return loaded_ ? loaded_->device_bytes() : copy_.bytes(); }
  /// Returns the buffer for the next load; it is empty if this object is a copy.
  DeviceBuffer take_buffer() && {
    return loaded_ ? std::move(*std::exchange(loaded_, std::nullopt)).take_buffer() : DeviceBuffer{};
  }

 private:
  std::optional<DeviceGrid> loaded_;
  DeviceArray<std::byte> copy_;  // rounded up to a multiple of 16 bytes
  std::uint64_t bytes_ = 0;
};

}  // namespace weir
