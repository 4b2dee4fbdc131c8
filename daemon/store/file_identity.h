// The identity of a file on disk, and whether the file exists.
#pragma once

#include <sys/stat.h>

#include <optional>
#include <string>

#include "daemon/store/job.h"

namespace weir {

FileIdentity identity_of(const struct stat& status);

/// Returns the identity of the regular file that `path` leads to; none if there is no regular file or it cannot be
/// looked at.
std::optional<FileIdentity> identify(const std::string& path);

/// Returns whether this errno of a look at a path means that nothing is there. Other errors (a server that does not
/// answer, a directory that may not be entered) say nothing about the file.
bool says_missing(int error);

/// Returns whether there is no regular file at `path`. False if the path cannot be looked at.
bool is_gone(const std::string& path);

/// Returns whether the watched directory exists, but no regular file at `path`. While the directory is missing, for
/// example before it is mounted, nothing is known about its files.
bool is_gone_from(const std::string& directory, const std::string& path);

}  // namespace weir
