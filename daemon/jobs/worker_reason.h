// Why a worker ended as it did, in the words of the program itself where it said any.
#pragma once

#include <string>
#include <string_view>

#include "daemon/jobs/worker_process.h"

namespace weir {

inline constexpr int kSignalExit = 128;  ///< and the signal's number: WorkerEnd::exit_code

/// The line that `weir` ends with where it fails, without its name; of a signal, which leaves none, its name. `step` is
/// the subcommand.
std::string worker_reason(std::string_view step, const WorkerEnd& end);

/// Whether the system says by this number that a file system, or a quota of it, is full.
bool is_disk_full(int errno_value);
/// Whether `reason` does, in the system's words: of a program that announces no numbers.
bool says_disk_full(std::string_view reason);

}  // namespace weir
