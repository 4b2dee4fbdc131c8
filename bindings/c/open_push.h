// The weir_push handle: a push as the C interface holds it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>

#include "bindings/c/conversion_options.h"
#include "bindings/c/weir.h"
#include "compressor/push/pushed_volume.h"

namespace weir::c {

/// Slabs on their way to a push. The push is created before this object and must outlive it.
class PushInFlight {
 public:
  PushInFlight() = default;
  virtual ~PushInFlight() = default;
  PushInFlight(const PushInFlight&) = delete;
  PushInFlight& operator=(const PushInFlight&) = delete;

  /// Takes planes [z0, z0 + nz) of the host, as PushedVolume::slab(); returns false if the volume must take them
  /// itself.
  virtual bool add(std::int64_t /*z0*/, std::int64_t /*nz*/, const void* /*data*/,
                   const std::array<std::int64_t, 3>& /*stride*/) {
    return false;
  }
  /// Waits until all slabs have arrived. Throws the error that ended the push.
  virtual void finish() = 0;
  /// After finish(): returns the source of all values if the volume was not filled with them; otherwise null.
  virtual VolumeSource* whole() { return nullptr; }
};

/// Begins a push. Throws Error.
std::unique_ptr<weir_push> begin_push(const weir_volume* volume, const weir_convert_options* options,
                                      const char* output);

/// Returns the `stride` that a slab was given; if it is null, the stride of values without gaps.
std::array<std::int64_t, 3> slab_stride(const PushedVolume& volume, const std::int64_t* stride);

/// Takes planes of the host. Throws Error.
void push_host_slab(weir_push& push, std::int64_t z0, std::int64_t nz, const void* data,
                    const std::array<std::int64_t, 3>& stride);

/// Waits for the slabs in flight, and writes the file. Throws Error.
void end_push(weir_push& push);

}  // namespace weir::c

/// A member that must outlive another one comes before it.
struct weir_push {
  explicit weir_push(const weir_convert_options& given) : callbacks(given), files(weir::make_posix_file_system()) {}

  weir::c::Callbacks callbacks;
  weir::Notice notice;
  std::uint64_t memory = 0;  // memory of the options
  std::unique_ptr<weir::FileSystem> files;
  std::unique_ptr<weir::BlockCoder> coder;
  std::unique_ptr<weir::PushedVolume> volume;
  std::mutex mutex;                                  // guards the members below
  std::uint64_t device_memory = 0;                   // bytes of the device in which slabs may wait
  bool filled = false;                               // whether some planes have come from the host
  std::unique_ptr<weir::c::PushInFlight> in_flight;  // null before the first slab of a device
};
