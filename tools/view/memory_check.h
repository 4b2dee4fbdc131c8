// Checks before the page is served whether weir view can draw anything in the memory that it is given.
#pragma once

#include <functional>
#include <string>

#include "gpu/volume/voxel_memory.h"
#include "tools/view/steps/viewed_files.h"

namespace weir {

/// Throws Error(usage), "FILE: " and the message of plan_voxels, if a given ceiling is too small for every step that
/// can be read (naming the first step) or for the single file that all are compared with. Throws as NvdbFile if that
/// file cannot be read. `named` returns the name that the user gave a file.
void require_memory(const ViewedFiles& files, const VoxelMemory& memory,
                    const std::function<std::string(const std::string& path)>& named);

}  // namespace weir
