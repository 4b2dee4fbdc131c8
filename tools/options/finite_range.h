// The range of a file's finite values where its root names none that is finite, as where infinities were kept.
#pragma once

#include <optional>

#include "format/nanovdb/nvdb_file.h"
#include "gpu/volume/macrocell_grid.h"

namespace weir {

/// As the file's root says, else as certified_range; none where neither has one.
std::optional<MinMax> known_range(const NvdbFile& file);
/// As the certificate that belongs to the file says; none where it has none. Throws as own_sidecar.
std::optional<MinMax> certified_range(const NvdbFile& file);

}  // namespace weir
