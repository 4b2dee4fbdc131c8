// Loads the configuration of `weir watch`. Loading checks everything that can be checked without opening volumes, so
// that a reload of a faulty file changes nothing.
#pragma once

#include <string>

#include "daemon/config/config.h"

namespace weir {

/// Reads and checks `path`. Relative paths in the file are relative to its directory. Throws Error(input) with
/// "PATH:LINE:COLUMN: ..." for an unknown key, a wrong value or a contradiction; Error(input) if a file is missing,
/// Error(io) if this user may not read a file.
DaemonConfig load_config(const std::string& path);

}  // namespace weir
