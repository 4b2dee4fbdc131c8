// Whether weir view can draw anything in the memory that it is given, asked before its page is there.
#pragma once

#include <functional>
#include <string>

#include "gpu/volume/voxel_memory.h"
#include "tools/view/steps/viewed_files.h"

namespace weir {

/// Throws Error(usage), "FILE: " and what plan_voxels says, where a given ceiling is too small for all steps that can
/// be read, then of the first one, or for the one file that all are compared with. Throws as NvdbFile where that one
/// cannot be read. `named` gives what the user has called a file.
void require_memory(const ViewedFiles& files, const VoxelMemory& memory,
                    const std::function<std::string(const std::string& path)>& named);

}  // namespace weir
