// Removes an output that verify found to differ from what was written.
#pragma once

#include <optional>
#include <string>

#include "daemon/store/job.h"
#include "format/io/file_system.h"

namespace weir {

/// Removes the volume `output` and then its sidecar, so that nobody takes them for a result. Holds the output's lock,
/// OUT.nvdb.partial, so that nobody replaces the files during the removal. `verified` is the volume's identity before
/// it was verified. If another file is there now, or another process has the lock, nothing is removed. Returns the
/// end of a message, one line: "removed", or what was not removed, why, and what to do.
std::string remove_wrong_output(FileSystem& files, const std::string& output,
                                const std::optional<FileIdentity>& verified);

}  // namespace weir
