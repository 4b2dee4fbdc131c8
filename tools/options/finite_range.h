// The range of a file's finite values. The root of a file that kept infinities has no finite range.
#pragma once

#include <optional>

#include "format/nanovdb/nvdb_file.h"
#include "gpu/volume/macrocell_grid.h"

namespace weir {

/// Returns the range in the file's root if that is finite, otherwise certified_range(). An unreadable sidecar counts
/// as none.
std::optional<MinMax> known_range(const NvdbFile& file);
/// Returns the range in the sidecar that belongs to the file; nullopt if there is no such sidecar or the range is not
/// finite. Throws as own_sidecar.
std::optional<MinMax> certified_range(const NvdbFile& file);

}  // namespace weir
