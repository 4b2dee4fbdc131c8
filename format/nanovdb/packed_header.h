// The fixed part of packed data (FORMAT.md, "Packed data"): header and tables, checked, and the entries of the region
// table. They are copied out of the file, so that they outlive it.
#pragma once

#include <array>
#include <cstdint>

#include "format/base/index.h"
#include "format/nanovdb/nvdb_bytes.h"
#include "format/packed/block_constants.h"

namespace weir {

struct PackedHeader {
  std::uint64_t bytes = 0;  ///< bytes of all packed data
  bool preview = false;     ///< the tree holds the blocks' means as tiles
  NodeLattice regions;      ///< regions of 128^3 voxels over the grid's index box
  std::uint64_t table = 0;  ///< offset of the region table from the packed data's first byte
  std::array<std::uint16_t, std::size_t{kPackedTables} * kPackedSymbols> frequencies{};

  /// Returns the constants with the tables; they point into this object.
  BlockConstants constants() const {
    BlockConstants all = values;
    all.tables = frequencies.data();
    return all;
  }
  BlockConstants values;  ///< without the tables
};

/// An entry of the region table.
struct PackedRegion {
  std::uint64_t chunk = 0;  ///< offset of the streams and their directory from the packed data; 0: none
  std::uint32_t bytes = 0;  ///< of the chunk
  float value = 0;          ///< value of all voxels of the region's blocks without a stream
};

/// Checks the header, tables and region table of `data`, which holds exactly the packed data of a grid with the index
/// box `bbox`. Throws Error(input) that names offset and value.
PackedHeader read_packed_header(const NvdbBytes& data, const Box& bbox);

/// Returns the entry of the region at lattice position `position`; read_packed_header() has checked it.
PackedRegion packed_region(const NvdbBytes& data, const PackedHeader& header, const Index3& position);

}  // namespace weir
