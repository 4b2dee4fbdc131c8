// Whether a sidecar is of the very file that it lies beside: a crash between two renames, or a copy, may leave
// another's.
#pragma once

#include "format/nanovdb/nvdb_grid.h"
#include "format/sidecar/sidecar.h"

namespace weir {

/// By the file's length and the checksum of its head. Volumes of equal range and topology may have equal ones: where
/// OUT.nvdb.json.previous or OUT.nvdb.partial lies beside the file, as a commit that was killed leaves them, also by
/// the digest of all its bytes, which are read for it.
bool is_of(const Sidecar& sidecar, const NvdbGrid& grid);

}  // namespace weir
