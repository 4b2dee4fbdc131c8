// The warning about a grid that does not lie along the world's axes.
#pragma once

#include <array>
#include <string>

#include "format/nanovdb/nvdb_grid.h"

namespace weir {

/// Returns an empty text if the row-major `matrix` only scales by the voxel size, as in weir's files. Otherwise, for
/// example for a level set rotated in another program, says that pictures and positions follow the grid's own axes.
std::string map_warning(const std::array<double, 9>& matrix, const std::array<double, 3>& voxel_size);
std::string map_warning(const NvdbGrid& grid);

}  // namespace weir
