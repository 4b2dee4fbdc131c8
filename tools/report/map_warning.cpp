#include "tools/report/map_warning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace weir {

std::string map_warning(const std::array<double, 9>& matrix, const std::array<double, 3>& size) {
  const double slack = 1e-6 * *std::max_element(size.begin(), size.end());
  bool scales = true;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      const double expected = row == column ? size[row] : 0;
      scales = scales && std::abs(matrix[3 * row + column] - expected) <= slack;
    }
  }
  return scales
             ? ""
             : "its map rotates, shears or mirrors the grid; pictures and positions follow the grid's own axes, with "
               "its voxel size alone";
}

std::string map_warning(const NvdbGrid& grid) { return map_warning(grid.matrix(), grid.voxel_size()); }

}  // namespace weir
