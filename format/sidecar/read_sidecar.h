// The sidecar of a volume, from disk.
#pragma once

#include <optional>
#include <string>

#include "format/nanovdb/nvdb_file.h"
#include "format/sidecar/sidecar.h"

namespace weir {

/// Reads and parses the sidecar at `path`. Throws Error(input) where it is missing, larger than any
/// sidecar, or invalid, Error(io) where it cannot be read; the message has the remedy.
Sidecar read_sidecar(const std::string& path);

/// The one that lies beside the file and is of it (is_of.h); none else. Throws as read_sidecar.
std::optional<Sidecar> own_sidecar(const NvdbFile& file);

}  // namespace weir
