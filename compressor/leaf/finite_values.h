// Whether all voxels of a leaf are finite.
#pragma once

#include "format/leaf/leaf_codec.h"

namespace weir {

bool all_finite(const LeafValues& values);

}  // namespace weir
