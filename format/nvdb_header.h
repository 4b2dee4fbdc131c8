// The head of a NanoVDB file: segment header, meta data, names, and the fixed
// part of the first grid. See FORMAT.md, "File".
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "format/nvdb_type.h"

namespace weir {

struct NvdbHeader {
  std::uint64_t grid_offset = 0;  ///< bytes from the file's start
  std::uint64_t grid_bytes = 0;   ///< inside the file, at least the fixed head of a grid
  std::uint32_t version = 0;      ///< of the grid: major << 21 | minor << 10 | patch
  GridType type = GridType::float32;
  std::string name;
  std::array<double, 3> voxel_size{};
  std::array<double, 3> world_origin{};
};

/// "32.4.2".
std::string nvdb_version_text(std::uint32_t version);

/// Reads and checks the head of the first grid of `file`. Throws Error(input) naming the offset, the
/// value and the remedy where the file is no NanoVDB file of major version 32, is truncated, is
/// compressed, or holds another type of grid.
NvdbHeader read_nvdb_header(std::span<const std::byte> file, const std::string& path);

}  // namespace weir
