// The sidecar of a volume, from disk.
#pragma once

#include <string>

#include "format/sidecar/sidecar.h"

namespace weir {

/// Reads and parses the sidecar at `path`. Throws Error(input) where it is missing, larger than any
/// sidecar, or invalid; the message has the remedy.
Sidecar read_sidecar(const std::string& path);

}  // namespace weir
