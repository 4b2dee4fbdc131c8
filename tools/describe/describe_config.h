// Describes a daemon's configuration, defaults included, for people.
#pragma once

#include <string>

#include "daemon/config/config.h"

namespace weir {

/// Returns a paragraph for the service and one for each watch; every line ends with a newline.
std::string describe_config(const DaemonConfig& config);

}  // namespace weir
