// Files written by stock NanoVDB from an OpenVDB grid, with the stock accessor
// as the oracle. The only test source that compiles OpenVDB's headers is behind it.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "format/base/index.h"
#include "format/layout/nvdb_type.h"

namespace weir::test {

/// One grid of the sample: leaves around the origin, at negative coordinates and in four root tiles,
/// active and inactive tiles of 8, 128 and 4096 voxels, a leaf of one value, background 0.25.
/// Voxel size 0.5, origin (10, 20, 30), name "sample".
class StockNvdb {
 public:
  explicit StockNvdb(GridType type);
  ~StockNvdb();

  /// The file as written by nanovdb::io::writeGrid.
  std::vector<std::byte> file() const;
  /// Two grids in one segment: this one and a smaller one of the name "second".
  std::vector<std::byte> file_of_two() const;

  /// What the stock accessor of the handle says.
  float value(const Index3& i) const;
  bool active(const Index3& i) const;
  Box index_bbox() const;
  std::uint64_t active_voxels() const;
  float min() const;
  float max() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Boxes in which the sample has content, edges of every kind of node included.
std::vector<Box> stock_sample_boxes();

/// Plain file access for tests.
std::vector<std::byte> read_whole(const std::string& path);
void write_whole(const std::string& path, const std::vector<std::byte>& bytes);

}  // namespace weir::test
