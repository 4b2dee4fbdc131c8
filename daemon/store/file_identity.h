// The identity of a file on disk, and whether there is one.
#pragma once

#include <sys/stat.h>

#include <optional>
#include <string>

#include "daemon/store/job.h"

namespace weir {

FileIdentity identity_of(const struct stat& status);

/// Of what `path` leads to; none where that is no regular file or cannot be looked at.
std::optional<FileIdentity> identify(const std::string& path);

/// Whether this errno of a look at a path means that nothing is there. The others (a server that does not answer,
/// a directory that may not be entered) say nothing about the file.
bool says_missing(int error);

/// Whether there is no regular file at `path`. False where it cannot be looked at.
bool is_gone(const std::string& path);

/// Whether there is no regular file at `path`, but the directory that it is watched in. Where that is not there, as
/// before it is mounted, nothing is known of its files.
bool is_gone_from(const std::string& directory, const std::string& path);

}  // namespace weir
