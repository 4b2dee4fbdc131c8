// A .vdb file as OpenVDB itself reads it, held against the NanoVDB grid it was made of. The only test source here that
// compiles OpenVDB's tree is behind it.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <string>

#include "format/nanovdb/nvdb_grid.h"

namespace weir::test {

struct VdbFacts {
  std::string name;
  std::string creator;  ///< metadata of the file
  bool half = false;
  std::map<std::string, std::string> metadata;   ///< of the grid, as OpenVDB words the values
  std::array<double, 3> origin{};                ///< world position of index 0, 0, 0
  std::array<std::array<double, 3>, 3> steps{};  ///< world step of one voxel along x, y, z
  std::string map;                               ///< "UniformScaleTranslateMap"
};

/// What OpenVDB says about the only grid of the file. Throws what OpenVDB throws.
VdbFacts read_facts(const std::string& path);

/// The first thing in which the tree in the file differs from `grid`: background, number of nodes and tiles, the level,
/// state and value of each tile, the state and value of each voxel, bit for bit after `expected` has been applied to
/// the grid's. Empty where there is none.
std::string difference(
    const NvdbGrid& grid, const std::string& path,
    const std::function<float(float)>& expected = [](float value) { return value; });

}  // namespace weir::test
