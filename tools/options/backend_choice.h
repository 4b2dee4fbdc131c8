// Which back end a picture is made with: --backend, --devices, --threads, --memory and --device-memory.
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
  std::string name;          ///< "auto": CUDA where there is a device, else the CPU; "cuda", "cpu"
  std::vector<int> devices;  ///< of CUDA
  int threads = 0;           ///< of the CPU; 0: all of the machine's
  VoxelMemory memory = {};   ///< of the CPU; how many volumes are held, of both
  std::optional<std::uint64_t> device_memory = std::nullopt;  ///< of each CUDA device, bytes
};

/// `notice` is called with a warning where the choice is of devices and the CPU draws. Throws Error(usage) for "cuda"
/// where this build or this machine has none.
std::unique_ptr<Backend> make_backend(const BackendChoice& choice, const std::function<void(const Message&)>& notice);

/// Such a notice as a warning in the log.
void warn(const Message& notice);

/// Voxels along the edge of the macrocells that the back end takes where Backend::load is asked for none.
std::int64_t own_macrocell(const Backend& backend);

}  // namespace weir
