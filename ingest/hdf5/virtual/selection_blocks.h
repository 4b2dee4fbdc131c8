// Splits a selection of the library into boxes.
#pragma once

#include <hdf5.h>

#include <cstddef>
#include <optional>
#include <vector>

#include "ingest/hdf5/virtual/coverage.h"

namespace weir {

/// Returns the elements selected in `space`, a hyperslab, as boxes that do not overlap. For a regular hyperslab,
/// boxes that touch along an axis are joined. Returns nullopt if there are more than `most` boxes or the library
/// cannot say. The caller holds Hdf5Lock.
std::optional<std::vector<AxisBox>> selection_blocks(hid_t space, std::size_t most);

}  // namespace weir
