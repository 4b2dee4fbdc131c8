// Explains why a worker ended, in the program's own words if it wrote any.
#pragma once

#include <string>
#include <string_view>

#include "daemon/jobs/worker_process.h"

namespace weir {

inline constexpr int kSignalExit = 128;  ///< plus the signal's number: WorkerEnd::exit_code

/// Returns the line that `weir` ends with when it fails, without the program's name. A signal leaves no line; then
/// the signal's name is returned. `step` is the subcommand.
std::string worker_reason(std::string_view step, const WorkerEnd& end);

/// Returns whether `errno_value` means that a file system, or a quota on it, is full.
bool is_disk_full(int errno_value);
/// Returns whether `reason` contains the system's words for a full disk: for programs that announce no error numbers.
bool says_disk_full(std::string_view reason);

}  // namespace weir
