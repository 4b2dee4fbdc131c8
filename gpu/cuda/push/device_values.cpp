#include "gpu/cuda/push/device_values.h"

#include <algorithm>
#include <cstdint>

#include "format/base/error.h"
#include "format/base/text.h"
#include "gpu/cuda/runtime/check.h"
#include "gpu/cuda/runtime/current_device.h"

namespace weir {

bool without_gaps(const DeviceValues& values, const Index3& extent) {
  const auto bytes = static_cast<std::int64_t>(values.value_bytes);
  return values.stride[0] == bytes && values.stride[1] == bytes * extent.x &&
         (extent.z == 1 || values.stride[2] == bytes * extent.x * extent.y);
}

void check_slab(const DeviceValues& values, int device) {
  const int current = existing_current_device();
  if (current != device) {
    throw Error(ErrorKind::usage, cat("device ", current, " is current, and the first slab came from device ", device,
                                      "; make that one current"));
  }
  const auto bytes = static_cast<std::int64_t>(values.value_bytes);
  const bool aligned = reinterpret_cast<std::uintptr_t>(values.first) % values.value_bytes == 0 &&
                       std::ranges::all_of(values.stride, [&](std::int64_t s) { return s % bytes == 0; });
  if (!aligned) {
    throw Error(ErrorKind::usage, cat("on a device, the address and the strides of values must be multiples of the ",
                                      bytes, " bytes of a value"));
  }
}

void check_reach(const DeviceValues& values, const Index3& extent, const DevicePlace& place) {
  const int current = existing_current_device();
  if (place.managed || place.device == current || without_gaps(values, extent)) return;
  throw Error(ErrorKind::usage, cat("values lie on device ", place.device, ", and device ", current,
                                    " is current, which can copy them only where there are no gaps between them; make "
                                    "the other one current, or copy them together first"));
}

std::optional<DevicePlace> device_place(const void* address) {
  if (device_count() == 0) return std::nullopt;
  cudaPointerAttributes attributes{};
  check_cuda(cudaPointerGetAttributes(&attributes, address), "asking where values are");
  const bool managed = attributes.type == cudaMemoryTypeManaged;
  if (!managed && attributes.type != cudaMemoryTypeDevice) return std::nullopt;
  return DevicePlace{attributes.device, managed};
}

bool is_device_memory(const void* address) { return device_place(address).has_value(); }

bool lies_on(const void* address, int device) {
  const std::optional<DevicePlace> place = device_place(address);
  return place && (place->managed || place->device == device);
}

}  // namespace weir
