#include "gpu/cuda/push/resident_planes.h"

#include <utility>

#include "gpu/cuda/push/gather_planes.h"
#include "gpu/cuda/runtime/caller_stream.h"
#include "gpu/cuda/runtime/check.h"

namespace weir {
namespace {

constexpr const char* kCopyingPlanes = "copying a slab on the device";

}  // namespace

ResidentPlanes::ResidentPlanes(const Index3& extent) : extent_(extent), values_(voxels(extent.z)) {}

ResidentPlanes::~ResidentPlanes() {
  free_on(context_, [&] {
    for (CopyEvent& copied : copied_) {
      try {
        copied.wait(kCopyingPlanes);
      } catch (const Error&) {  // the failure was reported where it could be
      }
    }
    copied_.clear();
    values_ = {};
  });
}

void ResidentPlanes::add(std::int64_t z0, std::int64_t nz, const DeviceValues& values, cudaStream_t callers) {
  check_slab(values, device_);
  const cudaStream_t stream = caller_stream(callers);
  float* const to = values_.data() + voxels(z0);
  CopyEvent copied;
  try {
    if (without_gaps(values, extent_)) {
      check_cuda(cudaMemcpyAsync(to, values.first, voxels(nz) * sizeof(float), cudaMemcpyDefault, stream),
                 kCopyingPlanes);
    } else {
      gather_planes(values, {extent_.x, extent_.y, nz}, reinterpret_cast<std::byte*>(to), stream);
    }
    copied.record(stream);
  } catch (...) {
    cudaStreamSynchronize(stream);  // nothing may write to the memory once it is freed
    throw;
  }
  const std::lock_guard lock(mutex_);
  while (!copied_.empty() && copied_.front().done()) copied_.pop_front();
  copied_.push_back(std::move(copied));
}

void ResidentPlanes::add(const Index3& first, const float* values, std::size_t count) {
  const KeptDevice kept(context_);
  check_cuda(cudaMemcpyAsync(values_.data() + linear_index(first, extent_), values, count * sizeof(float),
                             cudaMemcpyHostToDevice, cudaStreamPerThread),
             kCopyingPlanes);
  check_cuda(cudaStreamSynchronize(cudaStreamPerThread), kCopyingPlanes);
}

void ResidentPlanes::finish() {
  const KeptDevice kept(context_);
  const std::lock_guard lock(mutex_);
  for (CopyEvent& copied : copied_) copied.wait(kCopyingPlanes);
}

}  // namespace weir
