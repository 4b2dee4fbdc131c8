#include "gpu/cuda/push/resident_planes.h"

#include "gpu/cuda/push/device_slabs.h"
#include "gpu/cuda/runtime/check.h"

namespace weir {
namespace {

constexpr const char* kCopyingPlanes = "copying a slab on the device";

}  // namespace

ResidentPlanes::ResidentPlanes(const Index3& extent) : extent_(extent) {
  check_cuda(cudaGetDevice(&device_), "asking for the current device");
  values_ = DeviceArray<float>(voxels(extent.z));
}

ResidentPlanes::~ResidentPlanes() {
  try {
    finish();
  } catch (const Error&) {  // it was said where it could be
  }
}

void ResidentPlanes::add(std::int64_t z0, std::int64_t nz, const DeviceValues& values, cudaStream_t stream) {
  check_slab(values, device_);
  float* const to = values_.data() + voxels(z0);
  if (without_gaps(values, extent_)) {
    check_cuda(cudaMemcpyAsync(to, values.first, voxels(nz) * sizeof(float), cudaMemcpyDefault, stream),
               kCopyingPlanes);
  } else {
    gather_planes(values, {extent_.x, extent_.y, nz}, reinterpret_cast<std::byte*>(to), stream);
  }
  const std::lock_guard lock(mutex_);
  copied_.emplace_back();
  copied_.back().record(stream);
}

void ResidentPlanes::add(std::int64_t z0, std::int64_t nz, const float* values) {
  check_cuda(cudaMemcpyAsync(values_.data() + voxels(z0), values, voxels(nz) * sizeof(float), cudaMemcpyHostToDevice,
                             cudaStreamPerThread),
             kCopyingPlanes);
  check_cuda(cudaStreamSynchronize(cudaStreamPerThread), kCopyingPlanes);
}

void ResidentPlanes::finish() {
  const std::lock_guard lock(mutex_);
  for (CopyEvent& copied : copied_) copied.wait(kCopyingPlanes);
}

}  // namespace weir
