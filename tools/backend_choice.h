// Which back end a picture is made with: --backend auto, cpu or cuda.
#pragma once

#include <memory>
#include <string>

#include "gpu/backend.h"

namespace weir {

/// "auto" is the first CUDA device where there is one, else the CPU. `threads`: of the CPU, 0 for all. Throws
/// Error(usage) for "cuda" where this build or this machine has none.
std::unique_ptr<Backend> make_backend(const std::string& name, int threads);

}  // namespace weir
