// A volume of float32 values on a device, assembled from slabs on the same device. Each slab is copied in its
// caller's stream, at the device's own speed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>

#include "format/base/index.h"
#include "gpu/cuda/load/copy_event.h"
#include "gpu/cuda/push/device_values.h"
#include "gpu/cuda/runtime/current_device.h"
#include "gpu/cuda/runtime/device_array.h"

namespace weir {

class ResidentPlanes {
 public:
  /// Allocates memory of the current device for `extent` values, in the calling thread's context. Throws Error(io).
  explicit ResidentPlanes(const Index3& extent);
  /// Waits for copies in progress.
  ~ResidentPlanes();
  ResidentPlanes(const ResidentPlanes&) = delete;
  ResidentPlanes& operator=(const ResidentPlanes&) = delete;

  /// Queues the copy of planes [z0, z0 + nz), whose first voxel is values.first, in `stream`. Work that is queued
  /// there afterwards may change the values. Any thread may call this. Throws Error(usage) as check_slab() does, and
  /// Error(io).
  void add(std::int64_t z0, std::int64_t nz, const DeviceValues& values, cudaStream_t stream);
  /// Copies `count` values from the host to the voxels from `first` on, x fastest. The copy is complete when the call
  /// returns.
  void add(const Index3& first, const float* values, std::size_t count);

  /// Waits for all copies. Throws Error(io).
  void finish();

  int device() const { return device_; }
  const float* values() const { return values_.data(); }

 private:
  std::size_t voxels(std::int64_t planes) const { return static_cast<std::size_t>(extent_.x * extent_.y * planes); }

  Index3 extent_;
  int device_ = existing_current_device();
  SharedContext context_{device_};
  DeviceArray<float> values_;
  std::mutex mutex_;  // guards the members below
  std::deque<CopyEvent> copied_;
};

}  // namespace weir
