// The directory for temporary files.
#pragma once

#include <string>

namespace weir {

/// Returns TMPDIR, or /tmp. Throws Error(io), with the remedy, if that is not a directory.
std::string temporary_directory();

}  // namespace weir
