// A row-major volume cut into boxes that are contiguous in its file.
#pragma once

#include <cstdint>

#include "format/base/index.h"

namespace weir {

/// The box of at most `most_voxels` (>= 1) that begins at linear index `first` and is contiguous in a
/// row-major file of `extent`: whole planes where they fit, else whole rows of one plane, else a part
/// of a row; multiples of 32 or 8 planes or rows where so many fit, which synthetic fields fill fastest.
/// Calling it again from the end of each box covers the volume.
Box slab_at(const Index3& extent, std::int64_t first, std::int64_t most_voxels);

}  // namespace weir
