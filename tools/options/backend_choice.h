// Which back end a picture is made with: --backend, --devices, --threads and --memory.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "gpu/render/backend.h"

namespace weir {

struct BackendChoice {
  std::string name;          ///< "auto": CUDA where there is a device, else the CPU; "cuda", "cpu"
  std::vector<int> devices;  ///< of CUDA
  int threads = 0;           ///< of the CPU; 0: all of the machine's
  VoxelMemory memory = {};   ///< of the CPU
};

/// Throws Error(usage) for "cuda" where this build or this machine has none.
std::unique_ptr<Backend> make_backend(const BackendChoice& choice);

}  // namespace weir
