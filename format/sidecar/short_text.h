// The text of a sidecar, or of the lock of a commit, not parsed: what tells, after a crash, which volume is whose.
#pragma once

#include <string>

#include "format/io/file_system.h"

namespace weir {

/// All of `file`. Throws Error(input) where it is larger than any sidecar, Error(io) where it cannot be read.
std::string short_text(File& file);

/// The same of the file at `path`, which is opened for that.
std::string short_text(FileSystem& files, const std::string& path);

}  // namespace weir
