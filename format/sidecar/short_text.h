// Reads the unparsed text of a sidecar or of a commit's lock; after a crash it tells which sidecar belongs to which
// volume.
#pragma once

#include <string>

#include "format/io/file_system.h"

namespace weir {

/// Returns all of `file`. Throws Error(input) if it is larger than any sidecar, Error(io) if it cannot be read.
std::string short_text(File& file);

/// Opens the file at `path` and returns all of it. Throws the same errors.
std::string short_text(FileSystem& files, const std::string& path);

}  // namespace weir
