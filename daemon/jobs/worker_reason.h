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

}  // namespace weir
