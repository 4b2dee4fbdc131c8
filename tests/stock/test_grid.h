// Small grids in memory, written by stock NanoVDB from an OpenVDB grid, so that
// the renderer is tested on files that weir did not write.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "format/base/index.h"
#include "format/nanovdb/nvdb_grid.h"

namespace weir::test {

struct TestTile {
  Index3 origin;
  int dim = 8;  ///< 8, 128 or 4096
  float value = 0;
  bool active = true;
};

struct TestGridOptions {
  GridType type = GridType::float32;
  float background = 0;
  std::array<double, 3> voxel_size{1, 1, 1};
  std::vector<TestTile> tiles;
};

class TestGrid {
 public:
  using Value = std::function<float(const Index3&)>;

  /// Active voxels in `box` (may be empty) with value(index), then the tiles.
  TestGrid(const Box& box, const Value& value, const TestGridOptions& options = {});

  const NvdbGrid& grid() const { return *grid_; }
  std::span<const std::byte> file() const { return file_; }  ///< as on disk

 private:
  std::vector<std::byte> file_;
  std::unique_ptr<NvdbGrid> grid_;
};

}  // namespace weir::test
