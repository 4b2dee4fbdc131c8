// What to say of a grid that does not lie along the world's axes.
#pragma once

#include <array>
#include <string>

#include "format/nanovdb/nvdb_grid.h"

namespace weir {

/// Empty for a row-major matrix that scales by the voxel size alone, as those of weir's files do. Else, as of a level
/// set that was rotated in another program: that pictures and positions follow the grid's own axes.
std::string map_warning(const std::array<double, 9>& matrix, const std::array<double, 3>& voxel_size);
std::string map_warning(const NvdbGrid& grid);

}  // namespace weir
