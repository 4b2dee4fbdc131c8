// Whether a sidecar is of the very file that it lies beside: a crash between two renames, or a copy, may leave
// another's.
#pragma once

#include "format/nanovdb/nvdb_grid.h"
#include "format/sidecar/sidecar.h"

namespace weir {

/// By the file's length and the checksum of its head.
inline bool is_of(const Sidecar& sidecar, const NvdbGrid& grid) {
  return sidecar.file.bytes == grid.bytes().size() && sidecar.file.head_checksum == grid.head_checksum();
}

}  // namespace weir
