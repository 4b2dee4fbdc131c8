// Who surveys and encodes packed blocks: --backend of a conversion. Needs no CUDA toolkit; a program with
// weir_cuda_encode has the device.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "format/base/error.h"
#include "format/base/message.h"
#include "format/packed/block_coder.h"
#ifdef WEIR_HAVE_CUDA
#include "gpu/cuda/encode/device_coder.h"
#include "gpu/cuda/runtime/check.h"
#include "gpu/cuda/runtime/current_device.h"
#endif

namespace weir {

/// A device's driver takes some hundred MiB of the process: nobody who gives less memory gets one unasked.
inline constexpr std::uint64_t kLeastMemoryOfDevice = std::uint64_t{1} << 30U;

/// Says what a device has failed at, after which the CPU does its work.
inline std::function<void(const Error&)> say_device_failure(const Notice& notice) {
  return [notice](const Error& error) {
    if (notice)
      notice(cat("the CUDA device has failed (", error.what(), "); the CPU does its work, to the same bytes"));
  };
}

/// On the calling thread's current device, of a conversion whose blocks are `packed`, or may be no such ones, under a
/// ceiling of `memory` bytes; null: the CPU. What fails later, and with CoderChoice::automatic before, is said to
/// `notice`, once: the CPU goes on. Throws Error(usage) for CoderChoice::cuda where this build or this machine has no
/// device, and Error(io) where that has no room.
inline std::unique_ptr<BlockCoder> choose_coder(CoderChoice choice, bool packed, std::uint64_t memory,
                                                const Notice& notice) {
  if (choice == CoderChoice::cpu) return nullptr;
  if (choice == CoderChoice::automatic && (!packed || memory < kLeastMemoryOfDevice)) return nullptr;
#ifdef WEIR_HAVE_CUDA
  const auto failed = say_device_failure(notice);
  if (choice == CoderChoice::cuda) return make_device_coder(current_device(), failed);
  if (device_count() == 0) return nullptr;
  try {
    return make_device_coder(current_device(), failed);
  } catch (const Error& error) {
    failed(error);
    return nullptr;
  }
#else
  if (choice == CoderChoice::automatic) return nullptr;
  (void)notice;
  throw Error(ErrorKind::usage, compose(option("backend", "cuda"), ": this build has no CUDA encoder; use ",
                                        option("backend", "cpu"), " or auto"));
#endif
}

}  // namespace weir
