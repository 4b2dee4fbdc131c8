// The ways to store leaves: as float32, quantised to a few bits per voxel, or packed.
#pragma once

#include <string>

#include "format/layout/nvdb_type.h"

namespace weir {

/// automatic: float32 or fpn, whichever has less error at the requested size. fpn: 1, 2, 4, 8 or 16 bits per voxel,
/// chosen for each leaf. fp4, fp8 and fp16: 4, 8 or 16 bits per voxel in all leaves. packed: each 8^3 block is coded as
/// a whole, in the grid's blind data (FORMAT.md).
enum class Encoding { automatic, float32, fpn, fp4, fp8, fp16, packed };

/// Returns the name on the command line and in the sidecar: "auto", "float", "fpn", "fp4", "fp8", "fp16" or "packed".
std::string encoding_name(Encoding encoding);

/// Returns the grid type of an encoding, which must not be automatic. For packed it is the type of the tree that other
/// readers see.
GridType grid_type_of(Encoding encoding);

}  // namespace weir
