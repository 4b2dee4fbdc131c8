// The boxes that a selection of the library is made of.
#pragma once

#include <hdf5.h>

#include <cstddef>
#include <optional>
#include <vector>

#include "ingest/hdf5/virtual/coverage.h"

namespace weir {

/// The elements selected in `space`, a hyperslab, as boxes that do not overlap; those that touch along an axis of a
/// regular one are joined. nullopt where there are more than `most`, or the library cannot say. The
/// caller holds Hdf5Lock.
std::optional<std::vector<AxisBox>> selection_blocks(hid_t space, std::size_t most);

}  // namespace weir
