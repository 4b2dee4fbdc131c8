// Whether the CPU or a CUDA device surveys and encodes packed blocks: --backend of a conversion.
//
// All of it is inline because the answer depends on the program that includes it: one that links weir_cuda (which
// defines WEIR_HAVE_CUDA) can take a device, and one that does not compiles this without the CUDA toolkit. A source
// file of weir_gpu would be compiled once for both.
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

/// CoderChoice::automatic takes a device only if the conversion may use this much memory, because the device's driver
/// alone takes some hundred MiB of the process.
inline constexpr std::uint64_t kLeastMemoryOfDevice = std::uint64_t{1} << 30U;

/// Returns the function to call when a device fails: it tells `notice` (may be null) why, and that the CPU takes
/// over.
inline std::function<void(const Error&)> say_device_failure(const Notice& notice) {
  return [notice](const Error& error) {
    if (notice)
      notice(cat("the CUDA device has failed (", error.what(), "); the CPU does its work, to the same bytes"));
  };
}

/// Returns the coder that `choice` asks for: one on the calling thread's current device, or null for the CPU.
/// CoderChoice::cpu gives null. CoderChoice::automatic takes a working device if the conversion writes `packed`
/// blocks and its `memory` is kLeastMemoryOfDevice bytes or more; `notice` is told of a device that does not work.
/// CoderChoice::cuda takes the device. It throws Error(usage) if this build or this machine has none, Error(io) if
/// the device has no room. If the device fails later, `notice` is told once, and the CPU continues.
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
