// AMReX plotfiles as AMReX writes them, with a value of each cell that a function gives: for tests that read them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "format/base/index.h"

namespace weir::test {

/// The value of a cell, by level, component and index, which counts as the file does.
using PlotfileValue = std::function<double(std::size_t level, std::size_t component, const Index3& cell)>;

/// A whole number below 2^24, another one in each cell of a small plotfile.
double plain_plotfile_value(std::size_t level, std::size_t component, const Index3& cell);

struct PlotfilePlan {
  std::vector<std::string> components{"density"};
  Box domain{{0, 0, 0}, {16, 16, 16}};                               ///< of level 0
  std::vector<Index3> ratios;                                        ///< of level 1 to level 0, ...
  std::vector<std::vector<Box>> boxes{{{{0, 0, 0}, {16, 16, 16}}}};  ///< of each level, in its own cells
  bool single = false;                                               ///< float32, not float64
  bool big_endian = false;
  std::size_t fabs_per_file = 2;
  int version = 1;        ///< of Cell_H: 1 with FAB headers, 2 to 4 without
  int range_digits = 17;  ///< of the minima and maxima in Cell_H, after the point
  double time = 0.25;
  std::array<double, 3> corner{0, 0, 0};
  std::array<double, 3> spacing{1, 1, 1};  ///< of level 0
  std::string type = "HyperCLaw-V1.1";
  PlotfileValue value = plain_plotfile_value;

  std::size_t levels() const { return boxes.size(); }
  Box domain_of(std::size_t level) const;
  /// Cells of `fine` along one of `coarse`.
  Index3 ratio(std::size_t coarse, std::size_t fine) const;
};

/// Makes the directory `path` and all in it.
void write_plotfile(const std::string& path, const PlotfilePlan& plan);

/// The value that the composite of the levels up to `level` has at a cell of that level, counted as the file does: of
/// the finest level that has the cell. Looks at every box.
double composite_value(const PlotfilePlan& plan, std::size_t component, std::size_t level, const Index3& cell);

/// Disjoint boxes that fill `domain`, of 1 to `longest` cells along each axis, each kept with a probability of
/// `kept` / 100; the same for the same seed.
std::vector<Box> random_boxes(const Box& domain, std::int64_t longest, int kept, std::uint64_t seed);

/// A plotfile of the components density, x_velocity and Temp on 1 to 4 levels, by its number: ratios of 2, 3 and 4,
/// other ones along other axes, boxes of any size anywhere, each byte order, precision and version.
PlotfilePlan generated_plotfile(std::uint64_t seed);

}  // namespace weir::test
