// The removal of an output that is not what was written, as verify found.
#pragma once

#include <optional>
#include <string>

#include "daemon/store/job.h"
#include "format/io/file_system.h"

namespace weir {

/// Removes the volume `output` and then its sidecar, so that nobody takes them for a result, under the output's lock,
/// OUT.nvdb.partial: nobody replaces them meanwhile. `verified` is the volume as it was before it was verified; where
/// that is no longer what lies there, or another process has the lock, nothing is removed. Returns the end of a
/// message, one line: "removed", or what was not, why, and what to do.
std::string remove_wrong_output(FileSystem& files, const std::string& output,
                                const std::optional<FileIdentity>& verified);

}  // namespace weir
