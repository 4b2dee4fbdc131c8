// The head checksum of a grid, computed from its bytes. Apart from NvdbGrid, so that reading a file needs no zlib.
#pragma once

#include <cstdint>

#include "format/nanovdb/nvdb_grid.h"

namespace weir {

/// CRC-32 of the head (as the grid's version defines it, FORMAT.md) as it stands in the file; equals
/// grid.head_checksum() in an intact one.
std::uint32_t computed_head_checksum(const NvdbGrid& grid);

}  // namespace weir
