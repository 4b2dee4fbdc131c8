// Tells whether a sidecar belongs to the very file that it lies beside: a crash between two renames, or a copy, may
// leave the sidecar of another volume.
#pragma once

#include "format/io/file_system.h"
#include "format/nanovdb/nvdb_file.h"
#include "format/nanovdb/nvdb_grid.h"
#include "format/sidecar/sidecar.h"

namespace weir {

/// Returns whether a file has the length and the head checksum that a sidecar records. Another volume may have the
/// same.
bool has_head(const Sidecar::File& record, File& volume);

/// Returns whether `sidecar` has the file's length and the checksum of its head.
bool is_of(const Sidecar& sidecar, const NvdbGrid& grid);

/// Returns whether the sidecar beside a file belongs to it, by length and head checksum. Volumes of equal range and
/// topology may have equal heads. So if OUT.nvdb.partial or OUT.nvdb.json.previous shows that a killed commit may have
/// left another volume or sidecar, this also reads the whole file and compares its digest.
bool is_of(const Sidecar& sidecar, const NvdbFile& file);

}  // namespace weir
