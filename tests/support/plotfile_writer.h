// Writes AMReX plotfiles as AMReX writes them, for tests that read them. A function gives the value of each cell.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "format/base/index.h"

namespace weir::test {

/// Returns the value of a cell by level, component and index. Indices count as in the file.
using PlotfileValue = std::function<double(std::size_t level, std::size_t component, const Index3& cell)>;

/// Returns a whole number below 2^24, a different one for each cell of a small plotfile.
double plain_plotfile_value(std::size_t level, std::size_t component, const Index3& cell);

struct PlotfilePlan {
  std::vector<std::string> components{"density"};
  Box domain{{0, 0, 0}, {16, 16, 16}};                               ///< domain of level 0
  std::vector<Index3> ratios;                                        ///< ratio of level 1 to level 0, ...
  std::vector<std::vector<Box>> boxes{{{{0, 0, 0}, {16, 16, 16}}}};  ///< boxes of each level, in its own cells
  bool single = false;                                               ///< whether values are float32 and not float64
  bool big_endian = false;
  std::size_t fabs_per_file = 2;
  int version = 1;        ///< version of Cell_H: 1 with FAB headers, 2 to 4 without
  int range_digits = 17;  ///< digits after the point of the minima and maxima in Cell_H
  double time = 0.25;
  std::array<double, 3> corner{0, 0, 0};
  std::array<double, 3> spacing{1, 1, 1};  ///< spacing of level 0
  std::string type = "HyperCLaw-V1.1";
  PlotfileValue value = plain_plotfile_value;

  std::size_t levels() const { return boxes.size(); }
  Box domain_of(std::size_t level) const;
  /// Returns how many cells of level `fine` lie along one cell of level `coarse`.
  Index3 ratio(std::size_t coarse, std::size_t fine) const;
};

/// Makes the directory `path` and all files in it.
void write_plotfile(const std::string& path, const PlotfilePlan& plan);

/// Returns the value of the composite of all levels up to `level` at a cell of `level`: the value of the finest level
/// that has the cell. Indices count as in the file. Looks at every box.
double composite_value(const PlotfilePlan& plan, std::size_t component, std::size_t level, const Index3& cell);

/// Returns disjoint boxes in `domain`, which are the same for the same seed. The boxes have 1 to `longest` cells along
/// each axis and fill the domain, but each box is kept only with a probability of `kept` / 100.
std::vector<Box> random_boxes(const Box& domain, std::int64_t longest, int kept, std::uint64_t seed);

/// Returns the plan of plotfile number `seed` with the components density, x_velocity and Temp on 1 to 4 levels. Ratios
/// are 2, 3 and 4 and differ between axes. Boxes have any size and place. All byte orders, precisions and versions
/// occur.
PlotfilePlan generated_plotfile(std::uint64_t seed);

}  // namespace weir::test
