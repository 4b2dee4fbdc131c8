// The head of a NanoVDB file: segment headers, meta data, names, and the fixed
// part of a grid. See FORMAT.md, "File".
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "format/layout/nvdb_type.h"

namespace weir {

struct NvdbHeader {
  std::uint64_t grid_offset = 0;  ///< bytes from the file's start
  std::uint64_t grid_bytes = 0;   ///< inside the file, at least the fixed head of a grid
  std::uint32_t version = 0;      ///< of the grid: major << 21 | minor << 10 | patch
  GridType type = GridType::float32;
  bool has_min_max = true;  ///< whether the root's smallest and largest value are valid
  std::string name;
  std::array<double, 3> voxel_size{};
  std::array<double, 9> matrix{};  ///< row-major: world = matrix * index + world_origin
  std::array<double, 3> world_origin{};
};

/// The place of one grid in a file; offsets in bytes from the file's start.
struct NvdbRecord {
  std::uint64_t segment = 0;  ///< offset of the header of its segment
  std::uint64_t meta = 0;     ///< offset of its meta data
  std::uint64_t grid = 0;     ///< offset of the grid as stored; may lie beyond the file's end
};

/// Returns "32.4.2".
std::string nvdb_version_text(std::uint32_t version);

/// Returns the grids of the first segment of `file`, at least one. Throws Error(input) that names the offset, the value
/// and the remedy if the file is not a NanoVDB file of major version 32 or ends inside the meta data.
std::vector<NvdbRecord> first_nvdb_segment(std::span<const std::byte> file, const std::string& path);
/// Returns the grids of all segments, in the file's order. Throws as first_nvdb_segment().
std::vector<NvdbRecord> all_nvdb_segments(std::span<const std::byte> file, const std::string& path);
/// Returns the name of a grid that these functions found.
std::string nvdb_grid_name(std::span<const std::byte> file, const NvdbRecord& record);

/// Reads and checks the head of the grid at `record`. Throws Error(input) that names the offset, the value and the
/// remedy if the grid is truncated, compressed, or of a type that weir does not read.
NvdbHeader read_nvdb_header(std::span<const std::byte> file, const std::string& path, const NvdbRecord& record);

}  // namespace weir
