// Where temporary files go.
#pragma once

#include <string>

namespace weir {

/// TMPDIR, or /tmp. Throws Error(io), with the remedy, where that is no directory.
std::string temporary_directory();

}  // namespace weir
