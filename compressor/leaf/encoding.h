// How leaves are stored: as float32, or quantised to some bits a voxel.
#pragma once

#include <string>

#include "format/layout/nvdb_type.h"

namespace weir {

/// automatic: float32 or fpn, whichever has less error at the asked size. fpn: 1, 2, 4, 8 or 16 bits a voxel,
/// chosen for each leaf; fp4, fp8 and fp16: that many for all. packed: each 8^3 block coded as a whole, in the grid's
/// blind data (FORMAT.md).
enum class Encoding { automatic, float32, fpn, fp4, fp8, fp16, packed };

/// As on the command line and in the sidecar: "auto", "float", "fpn", "fp4", "fp8", "fp16" or "packed".
std::string encoding_name(Encoding encoding);

/// The grid type of a decided encoding (not automatic); of packed that of the tree that other readers see.
GridType grid_type_of(Encoding encoding);

}  // namespace weir
