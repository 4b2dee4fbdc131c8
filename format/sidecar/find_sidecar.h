// Where the sidecar of a file that is read lies.
#pragma once

#include <string>

namespace weir {

/// sidecar_path(volume_path); where nothing is there and the volume is a symbolic link, the sidecar's path beside the
/// file that it leads to, if one is there. For readers: what is written goes to sidecar_path.
std::string find_sidecar(const std::string& volume_path);

}  // namespace weir
