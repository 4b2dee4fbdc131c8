// Everything before the first upper node: file header, file meta data, padded
// name, GridData, TreeData, root and root tiles, with the head checksum.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "format/base/index.h"
#include "format/layout/node_statistics.h"
#include "format/layout/nvdb_type.h"
#include "format/layout/tree_layout.h"

namespace weir {

/// One entry of the root table.
struct RootTile {
  Index3 origin;            ///< lowest voxel, a multiple of 4096
  std::uint64_t child = 0;  ///< file offset of the upper node, 0 for a value tile
  bool active = false;      ///< value tiles only
  float value = 0;          ///< value tiles only
};

/// The most bytes of a grid's name in a NanoVDB file.
inline constexpr std::size_t kMaxGridNameBytes = 255;

struct GridHead {
  GridType type = GridType::float32;
  GridClass grid_class = GridClass::unknown;
  std::string name;                           ///< 1 to kMaxGridNameBytes bytes
  std::array<double, 3> voxel_size{1, 1, 1};  ///< > 0
  std::array<double, 3> origin{0, 0, 0};      ///< world position of index (0, 0, 0)
  float background = 0;
  NodeStatistics statistics;                    ///< of the whole grid; count = active voxels
  std::array<std::uint64_t, 3> active_tiles{};  ///< lower, upper and root level
  std::vector<RootTile> tiles;                  ///< sorted by origin x, y, z
  bool breadth_first = true;                    ///< leaves lie in traversal order and have one size
};

/// Returns the bytes [0, layout.uppers) of the file.
std::vector<std::byte> encode_head(const GridHead& head, const TreeLayout& layout);

/// Returns the blind data records, 288 bytes each: one for the macrocells, and one for packed data if there is any.
std::vector<std::byte> encode_blind_records(const TreeLayout& layout);

/// Returns the CRC-32 (0xEDB88320) of the head of a 32.4.2 grid: bytes [16, end of the root tiles) of the grid.
std::uint32_t head_checksum(std::span<const std::byte> grid_head);

}  // namespace weir
