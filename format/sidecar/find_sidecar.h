// Finds the sidecar of a file that is read.
#pragma once

#include <string>

namespace weir {

/// Returns sidecar_path(volume_path). If nothing is there and the volume is a symbolic link, returns the sidecar's path
/// beside the file that the link leads to, if a sidecar is there. For readers only: writers use sidecar_path().
std::string find_sidecar(const std::string& volume_path);

}  // namespace weir
