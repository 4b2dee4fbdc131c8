#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "bindings/c/open_push.h"
#include "bindings/c/status.h"
#include "bindings/c/weir_cuda.h"
#include "bindings/cuda/resident_choice.h"
#include "compressor/push/resident_source.h"
#include "format/base/scalar_type.h"
#include "format/process/fault.h"
#include "gpu/cuda/encode/resident_volume.h"
#include "gpu/cuda/push/device_slabs.h"
#include "gpu/cuda/push/resident_planes.h"
#include "gpu/cuda/runtime/caller_stream.h"
#include "gpu/cuda/runtime/check.h"
#include "gpu/packed/coder_choice.h"
#include "ingest/values/array_source.h"

using namespace weir;
using namespace weir::c;

namespace {

// Makes the call. If it throws, the values that it should have brought never come, so the whole push fails too.
template <typename Call>
void ending_with_failures(PushedVolume& volume, const Call& call) {
  try {
    call();
  } catch (...) {
    volume.fail(error_in_flight());
    throw;
  }
}

/// Slabs that come from a device.
class DeviceInFlight : public PushInFlight {
 public:
  virtual void add(std::int64_t z0, std::int64_t nz, const DeviceValues& values, cudaStream_t stream) = 0;
  using PushInFlight::add;
};

/// Slabs of a device on their way to `volume`.
class SlabsInFlight : public DeviceInFlight {
 public:
  SlabsInFlight(PushedVolume& volume, std::uint64_t device_bytes)
      : volume_(volume),
        slabs_(volume.info().extent, scalar_bytes(volume.info().type), device_bytes,
               [this](std::int64_t z0, std::int64_t nz, const std::byte* values) {
                 volume_.fill(z0, nz, values, packed_stride(volume_.info().extent, volume_.info().type));
               }) {}

  void add(std::int64_t z0, std::int64_t nz, const DeviceValues& values, cudaStream_t stream) override {
    slabs_.check(values);
    volume_.expect(z0, nz);
    ending_with_failures(volume_, [&] { slabs_.add(z0, nz, values, stream); });
  }

  void finish() override {
    ending_with_failures(volume_, [&] { slabs_.finish(); });
  }

 private:
  PushedVolume& volume_;
  DeviceSlabs slabs_;
};

// A whole volume on its device, which surveys and encodes it there.
class ResidentInFlight : public DeviceInFlight {
 public:
  /// For slabs that are copied to the current device.
  explicit ResidentInFlight(weir_push& push) : volume_(*push.volume), planes_(std::in_place, volume_.info().extent) {
    take(push, planes_->device(), planes_->values());
  }
  /// For `values` on `device`, which stay as they are.
  ResidentInFlight(weir_push& push, int device, const float* values) : volume_(*push.volume) {
    take(push, device, values);
    volume_.expect(0, volume_.info().extent.z);
  }

  void add(std::int64_t z0, std::int64_t nz, const DeviceValues& values, cudaStream_t stream) override {
    const Adding adding(adding_);
    check_slab(values, planes_->device());
    volume_.expect(z0, nz);
    ending_with_failures(volume_, [&] { planes_->add(z0, nz, values, stream); });
  }

  bool add(std::int64_t z0, std::int64_t nz, const void* data, const std::array<std::int64_t, 3>& stride) override {
    const Adding adding(adding_);
    required(data, "data");
    const SourceInfo& info = volume_.info();
    DenseArray array;
    array.data = data;
    array.extent = {info.extent.x, info.extent.y, nz};
    array.stride = stride;
    const std::unique_ptr<VolumeSource> slab = open_array(array);
    volume_.expect(z0, nz);
    ending_with_failures(volume_, [&] { copy_rows(*slab, z0, nz); });
    return true;
  }

  void finish() override {
    if (adding_ > 0) {
      throw Error(ErrorKind::usage,
                  cat(volume_.info().path, ": slabs are still being taken; end once every call has returned"));
    }
    if (planes_) ending_with_failures(volume_, [&] { planes_->finish(); });
  }

  VolumeSource* whole() override { return whole_.get(); }

 private:
  // Counts a slab from the beginning of its call until the call returns.
  class Adding {
   public:
    explicit Adding(std::atomic<int>& count) : count_(count) { ++count_; }
    ~Adding() { --count_; }
    Adding(const Adding&) = delete;
    Adding& operator=(const Adding&) = delete;

   private:
    std::atomic<int>& count_;
  };

  void take(weir_push& push, int device, const float* values) {
    const SourceInfo& info = volume_.info();
    whole_ = open_resident(make_resident_volume(device, values, info.domain(), say_device_failure(push.notice)), info);
  }

  // Copies some rows at a time.
  void copy_rows(VolumeSource& slab, std::int64_t z0, std::int64_t nz) {
    const Index3& extent = volume_.info().extent;
    constexpr std::int64_t kPieceValues = std::int64_t{1} << 20U;
    const std::int64_t rows = std::clamp<std::int64_t>(kPieceValues / extent.x, 1, extent.y);
    std::vector<float> piece;
    for (std::int64_t z = 0; z < nz; ++z) {
      for (std::int64_t y = 0; y < extent.y; y += rows) {
        const Box box{{0, y, z}, {extent.x, std::min(y + rows, extent.y), z + 1}};
        piece.resize(static_cast<std::size_t>(box.voxels()));
        slab.read(box, piece);
        planes_->add({0, y, z0 + z}, piece.data(), piece.size());
      }
    }
  }

  PushedVolume& volume_;
  std::optional<ResidentPlanes> planes_;
  std::unique_ptr<VolumeSource> whole_;
  std::atomic<int> adding_{0};
};

bool may_be_resident(const weir_push& push) {
  return !push.filled && may_stay_on_device(push.volume->info(), push.coder.get(), push.memory) &&
         push.volume->has_room_for(kResidentHostBytes);
}

// The slabs of several threads may come first at the same time, so the lock covers the creation.
DeviceInFlight& in_flight(weir_push& push) {
  const std::lock_guard lock(push.mutex);
  if (!push.in_flight) {
    const SourceInfo& info = push.volume->info();
    const auto bytes = static_cast<std::uint64_t>(volume(info.extent)) * sizeof(float);
    const bool resident = may_be_resident(push) && push.device_memory >= bytes;
    if (resident) push.in_flight = try_resident(push.notice, [&] { return std::make_unique<ResidentInFlight>(push); });
    // A device without room for the volume also has none for waiting slabs, which could be the whole volume again.
    const std::uint64_t granted = resident ? 0 : push.device_memory;
    if (!push.in_flight) push.in_flight = std::make_unique<SlabsInFlight>(*push.volume, granted);
  }
  return static_cast<DeviceInFlight&>(*push.in_flight);
}

void push_slab(weir_push& push, std::int64_t z0, std::int64_t nz, const void* data, const std::int64_t* stride,
               cudaStream_t stream) {
  required(data, "data");
  const SourceInfo& info = push.volume->info();
  const std::array<std::int64_t, 3> strides = slab_stride(*push.volume, stride);
  if (const std::optional<DevicePlace> place = device_place(data)) {
    push.callbacks.look_for_cancel();
    push.volume->check_slab(z0, nz, strides);
    const DeviceValues values{static_cast<const std::byte*>(data), strides, scalar_bytes(info.type)};
    check_reach(values, {info.extent.x, info.extent.y, nz}, *place);
    in_flight(push).add(z0, nz, values, stream);
    return;
  }
  if (device_count() > 0) check_cuda(cudaStreamSynchronize(caller_stream(stream)), "work before a slab");
  push_host_slab(push, z0, nz, data, strides);
}

// Takes the values in place if the whole volume lies on the device without gaps. Returns whether it has done so.
bool take_in_place(weir_push& push, const void* data, const std::int64_t* stride, cudaStream_t stream) {
  if (data == nullptr || !may_be_resident(push) || !is_device_memory(data)) return false;
  const DeviceValues values{static_cast<const std::byte*>(data), slab_stride(*push.volume, stride), sizeof(float)};
  int device = 0;
  check_cuda(cudaGetDevice(&device), "asking for the current device");
  if (!without_gaps(values, push.volume->info().extent) || !lies_on(data, device)) return false;
  check_slab(values, device);
  check_cuda(cudaStreamSynchronize(caller_stream(stream)), "work before a volume");
  push.in_flight = try_resident(
      push.notice, [&] { return std::make_unique<ResidentInFlight>(push, device, static_cast<const float*>(data)); });
  return push.in_flight != nullptr;
}

}  // namespace

weir_status weir_push_device_memory(weir_push* push, uint64_t bytes, weir_error* error) {
  return guarded(error, [&] {
    const std::lock_guard lock(required(push, "push")->mutex);
    if (push->in_flight) throw usage("device memory is granted before the first slab of a device, which has come");
    push->device_memory = bytes;
  });
}

weir_status weir_push_slab_device(weir_push* push, int64_t z0, int64_t nz, const void* data, const int64_t stride[3],
                                  void* stream, weir_error* error) {
  return guarded(error,
                 [&] { push_slab(*required(push, "push"), z0, nz, data, stride, static_cast<cudaStream_t>(stream)); });
}

weir_status weir_convert_device(const weir_volume* volume, const void* data, const int64_t stride[3], void* stream,
                                const weir_convert_options* options, const char* output, weir_error* error) {
  return guarded(error, [&] {
    const std::unique_ptr<weir_push> push = begin_push(volume, options, output);
    auto* const on = static_cast<cudaStream_t>(stream);
    if (!take_in_place(*push, data, stride, on)) push_slab(*push, 0, push->volume->info().extent.z, data, stride, on);
    end_push(*push);
  });
}
