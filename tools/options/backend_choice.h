// The options that choose what renders a picture: --backend, --devices, --threads, --memory and --device-memory.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "format/base/message.h"
#include "gpu/render/backend.h"

namespace weir {

struct BackendChoice {
  std::string name;          ///< "cuda", "cpu", or "auto": CUDA if there is a device, otherwise the CPU
  std::vector<int> devices;  ///< CUDA device numbers
  int threads = 0;           ///< CPU threads; 0: all of the machine's
  VoxelMemory memory = {};   ///< memory of the CPU back end; `volumes` and `levels` are for both back ends
  std::optional<std::uint64_t> device_memory = std::nullopt;  ///< bytes on each CUDA device
};

/// Makes the back end that `choice` names. Calls `notice` with a warning if `choice` sets devices or device memory but
/// the CPU draws. Throws Error(usage) for "cuda" if this build or this machine has no CUDA.
std::unique_ptr<Backend> make_backend(const BackendChoice& choice, const std::function<void(const Message&)>& notice);

/// Logs `notice`, from make_backend(), as a warning.
void warn(const Message& notice);

/// Returns the edge in voxels of the macrocells that `backend` uses when Backend::load is given no edge.
std::int64_t own_macrocell(const Backend& backend);

}  // namespace weir
