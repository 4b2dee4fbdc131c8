// OpenVDB and stock NanoVDB 10.0.1 as oracles: a tree built from values and
// tiles becomes the file that stock writes, and any file becomes what the stock
// reader sees in it. The only source here that compiles their headers is behind it.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "format/base/index.h"

namespace weir::test {

/// An OpenVDB tree in the making.
class StockTree {
 public:
  explicit StockTree(float background);
  ~StockTree();
  StockTree(StockTree&&) noexcept;

  /// A leaf; values and states at x<<6 | y<<3 | z.
  void add_leaf(const Index3& origin, std::span<const float, 512> values, const std::bitset<512>& active);
  /// A tile of `dim` = 8, 128 or 4096 voxels, below nodes that are made where needed.
  void add_tile(const Index3& origin, std::int64_t dim, float value, bool active);
  /// The file of openToNanoVDB (all statistics, partial checksum) and writeGrid.
  std::vector<std::byte> file(const std::string& name, const std::array<double, 3>& spacing,
                              const std::array<double, 3>& origin) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// What nanovdb::io::readGrid finds in a file, of whichever type its grid is: float, Fp4, Fp8, Fp16 or FpN.
class StockReader {
 public:
  explicit StockReader(std::span<const std::byte> file);
  ~StockReader();

  bool valid() const;  ///< the stock validator, checksum included
  std::string name() const;
  float value(const Index3& i) const;
  bool active(const Index3& i) const;
  Box index_bbox() const;
  std::uint64_t active_voxels() const;
  /// The bytes of the grid, from its header to the end of its padding.
  std::vector<std::byte> grid() const;
  /// The same after nanovdb::gridStats (StatsMode::All) has set all statistics and bounding boxes anew.
  std::vector<std::byte> grid_with_stock_statistics() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace weir::test
