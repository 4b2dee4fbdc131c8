// Computes the head checksum of a grid from its bytes. It is separate from NvdbGrid, so that reading a file needs no
// zlib.
#pragma once

#include <cstdint>

#include "format/nanovdb/nvdb_grid.h"

namespace weir {

/// Returns the CRC-32 of the head (as the grid's version defines it, FORMAT.md) of the bytes in the file. In an intact
/// file it equals grid.head_checksum().
std::uint32_t computed_head_checksum(const NvdbGrid& grid);

}  // namespace weir
