// Why the sources and the outputs of a watch cannot be judged now.
#pragma once

#include <string>

#include "daemon/config/config.h"

namespace weir {

/// Returns "DIRECTORY is not there; tried again once it is" if the watch's directory is missing, and the like if no
/// file system is mounted at its `output_mount`, as during a remount. Empty: both are there.
std::string away_disk(const WatchConfig& watch);

}  // namespace weir
