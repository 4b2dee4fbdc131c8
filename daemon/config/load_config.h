// The configuration of `weir watch` from its file. Loading checks everything that
// can be known without looking at volumes, so that a reload with a mistake in it
// changes nothing.
#pragma once

#include <string>

#include "daemon/config/config.h"

namespace weir {

/// Reads and checks `path`. Relative paths in it are relative to its directory. Throws Error(input) with
/// "PATH:LINE:COLUMN: ..." for an unknown key, a wrong value or a contradiction; Error(input) where a file is missing,
/// Error(io) where this user may not read it.
DaemonConfig load_config(const std::string& path);

}  // namespace weir
