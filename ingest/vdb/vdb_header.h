// Reads the part of a .vdb file that describes its grids, before their trees. OpenVDB's own reader allocates by sizes
// in the file; this reader trusts none of them.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "ingest/values/axis_placement.h"
#include "ingest/vdb/vdb_reader.h"

namespace weir {

/// OpenVDB's flags for the storage of a grid's values (openvdb/io/Compression.h).
inline constexpr std::uint32_t kVdbZip = 1;
inline constexpr std::uint32_t kVdbActiveMask = 2;
inline constexpr std::uint32_t kVdbBlosc = 4;

struct VdbGrid {
  std::string name;    ///< of the grid; "density[1]" if the file has several of one name, "[0]" if unnamed
  std::string tree;    ///< its type, "Tree_float_5_4_3"
  bool half = false;   ///< float or double saved as 16-bit floats
  std::string parent;  ///< for an instance: name of the grid that owns the shared tree; else empty
  std::uint32_t compression = 0;
  std::uint64_t tree_offset = 0;  ///< bytes from the file's start; meaningless for instances

  std::string map;  ///< "UniformScaleMap"
  bool linear = false;
  std::array<Vector3, 3> steps{};  ///< world step of one voxel along x, y, z; zero if not linear
  Vector3 first{};                 ///< world position of index (0, 0, 0)

  std::string grid_class;  ///< "fog volume"; empty if not stated
};

struct VdbHeader {
  std::uint32_t version = 0;        ///< of the file format
  std::uint32_t library_major = 0;  ///< of the OpenVDB that wrote it
  std::uint32_t library_minor = 0;  ///< of the OpenVDB that wrote it
  std::vector<VdbGrid> grids;       ///< in the file's order
};

/// Reads the head of every grid. `reader` stands at the file's beginning. Throws Error(input), naming the offset and
/// the value, if the file is no .vdb file, has a format older than OpenVDB 1.2 (2013) or newer than OpenVDB 10, was
/// written as a stream without offsets, or is cut.
VdbHeader read_vdb_header(VdbReader& reader);

}  // namespace weir
