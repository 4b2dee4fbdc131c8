// A grid's bytes where a device reads them.
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
  /// Of device memory, a buffer's that is larger than the grid counted whole: none where they stay in the host's.
  std::uint64_t device_bytes() const { return loaded_ ? loaded_->device_bytes() : copy_.bytes(); }
  /// For the next load; empty where this is a copy.
  DeviceBuffer take_buffer() && {
    return loaded_ ? std::move(*std::exchange(loaded_, std::nullopt)).take_buffer() : DeviceBuffer{};
  }

 private:
  std::optional<DeviceGrid> loaded_;
  DeviceArray<std::byte> copy_;  // up to a multiple of 16
  std::uint64_t bytes_ = 0;
};

}  // namespace weir
