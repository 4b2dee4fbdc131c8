// The identity of a file on disk.
#pragma once

#include <optional>
#include <string>

#include "daemon/job.h"

namespace weir {

/// Of what `path` leads to; none where that is no regular file.
std::optional<FileIdentity> identify(const std::string& path);

}  // namespace weir
