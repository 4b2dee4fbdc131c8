// Whether a sidecar is of the very file that it lies beside: a crash between two renames, or a copy, may leave
// another's.
#pragma once

#include "format/io/file_system.h"
#include "format/nanovdb/nvdb_file.h"
#include "format/nanovdb/nvdb_grid.h"
#include "format/sidecar/sidecar.h"

namespace weir {

/// Whether a file has the length and the head checksum that a sidecar records: so may another volume's.
bool has_head(const Sidecar::File& record, File& volume);

/// By the file's length and the checksum of its head.
bool is_of(const Sidecar& sidecar, const NvdbGrid& grid);

/// The same of a file, `sidecar` being the one beside it. Volumes of equal range and topology may have equal heads:
/// where a commit that was killed has left another volume or sidecar of that head there, OUT.nvdb.partial or
/// OUT.nvdb.json.previous, also by the digest of all its bytes, which are read for it.
bool is_of(const Sidecar& sidecar, const NvdbFile& file);

}  // namespace weir
