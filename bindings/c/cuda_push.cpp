#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>

#include "bindings/c/open_push.h"
#include "bindings/c/status.h"
#include "bindings/c/weir_cuda.h"
#include "format/base/scalar_type.h"
#include "gpu/cuda/push/device_slabs.h"
#include "gpu/cuda/runtime/check.h"
#include "ingest/values/array_source.h"

using namespace weir;
using namespace weir::c;

namespace {

/// Slabs of a device on their way to `volume`.
class SlabsInFlight : public PushInFlight {
 public:
  SlabsInFlight(PushedVolume& volume, std::uint64_t device_bytes)
      : volume_(volume),
        slabs_(volume.info().extent, scalar_bytes(volume.info().type), device_bytes,
               [this](std::int64_t z0, std::int64_t nz, const std::byte* values) {
                 volume_.fill(z0, nz, values, packed_stride(volume_.info().extent, volume_.info().type));
               }) {}

  void add(std::int64_t z0, std::int64_t nz, const DeviceValues& values, cudaStream_t stream) {
    slabs_.check(values);
    volume_.expect(z0, nz);
    ending_with_failures([&] { slabs_.add(z0, nz, values, stream); });
  }

  void finish() override {
    ending_with_failures([&] { slabs_.finish(); });
  }

 private:
  // Values that were expected do not come: that ends the push.
  template <typename Call>
  void ending_with_failures(const Call& call) {
    try {
      call();
    } catch (...) {
      volume_.fail(error_in_flight());
      throw;
    }
  }

  PushedVolume& volume_;
  DeviceSlabs slabs_;
};

// Slabs of several threads may be the first.
SlabsInFlight& in_flight(weir_push& push) {
  const std::lock_guard lock(push.mutex);
  if (!push.in_flight) push.in_flight = std::make_unique<SlabsInFlight>(*push.volume, push.device_memory);
  return static_cast<SlabsInFlight&>(*push.in_flight);
}

void push_slab(weir_push& push, std::int64_t z0, std::int64_t nz, const void* data, const std::int64_t* stride,
               cudaStream_t stream) {
  PushedVolume& volume = *push.volume;
  required(data, "data");
  const SourceInfo& info = volume.info();
  const std::array<std::int64_t, 3> strides = slab_stride(volume, stride);
  if (is_device_memory(data)) {
    in_flight(push).add(z0, nz, {static_cast<const std::byte*>(data), strides, scalar_bytes(info.type)}, stream);
    return;
  }
  if (device_count() > 0) check_cuda(cudaStreamSynchronize(stream), "work before a slab");
  volume.slab(z0, nz, data, strides);
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
    push_slab(*push, 0, push->volume->info().extent.z, data, stride, static_cast<cudaStream_t>(stream));
    end_push(*push);
  });
}
