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
  bool has_min_max = true;  ///< whether the root's smallest and largest value mean anything
  std::string name;
  std::array<double, 3> voxel_size{};
  std::array<double, 9> matrix{};  ///< row-major: world = matrix * index + world_origin
  std::array<double, 3> world_origin{};
};

/// Where one grid of a file lies; offsets in bytes from the file's start.
struct NvdbRecord {
  std::uint64_t segment = 0;  ///< of the header of its segment
  std::uint64_t meta = 0;     ///< of its meta data
  std::uint64_t grid = 0;     ///< of the grid as stored, perhaps beyond the file's end
};

/// "32.4.2".
std::string nvdb_version_text(std::uint32_t version);

/// The grids of the first segment of `file`, at least one. Throws Error(input) naming the offset, the value and the
/// remedy where the file is no NanoVDB file of major version 32 or ends inside the meta data.
std::vector<NvdbRecord> first_nvdb_segment(std::span<const std::byte> file, const std::string& path);
/// The grids of all segments, in the file's order. Throws the same.
std::vector<NvdbRecord> all_nvdb_segments(std::span<const std::byte> file, const std::string& path);
/// The name of a grid that these functions found.
std::string nvdb_grid_name(std::span<const std::byte> file, const NvdbRecord& record);

/// Reads and checks the head of the grid at `record`. Throws Error(input) naming the offset, the value and the remedy
/// where it is truncated, is compressed, or is of another type.
NvdbHeader read_nvdb_header(std::span<const std::byte> file, const std::string& path, const NvdbRecord& record);

}  // namespace weir
