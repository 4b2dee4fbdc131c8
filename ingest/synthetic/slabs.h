// Cuts a row-major volume into boxes that are contiguous in its file.
#pragma once

#include <cstdint>

#include "format/base/index.h"

namespace weir {

/// Returns the box of at most `most_voxels` (>= 1) that begins at linear index `first` and is contiguous in a
/// row-major file of `extent`. It is whole planes if they fit, otherwise whole rows of one plane, otherwise a part of
/// a row. The number of planes or rows is a multiple of 32 or 8 if so many fit, because synthetic fields fill these
/// fastest. Calling it again from the end of each box covers the volume.
Box slab_at(const Index3& extent, std::int64_t first, std::int64_t most_voxels);

}  // namespace weir
