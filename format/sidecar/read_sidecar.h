// Reads the sidecar of a volume from disk.
#pragma once

#include <optional>
#include <string>

#include "format/nanovdb/nvdb_file.h"
#include "format/sidecar/sidecar.h"

namespace weir {

/// Reads and parses the sidecar at `path`. Throws Error(input) if it is missing, larger than any sidecar, or invalid,
/// and Error(io) if it cannot be read; the message has the remedy.
Sidecar read_sidecar(const std::string& path);

/// Returns the sidecar beside the file if it belongs to the file (is_of.h); otherwise nullopt. Throws as
/// read_sidecar().
std::optional<Sidecar> own_sidecar(const NvdbFile& file);

}  // namespace weir
