// The identity of a file on disk.
#pragma once

#include <sys/stat.h>

#include <optional>
#include <string>

#include "daemon/job.h"

namespace weir {

FileIdentity identity_of(const struct stat& status);

/// Of what `path` leads to; none where that is no regular file.
std::optional<FileIdentity> identify(const std::string& path);

}  // namespace weir
