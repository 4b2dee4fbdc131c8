// How a command may use the machine: the same options for every command that
// streams a volume.
#pragma once

#include <oneapi/tbb/global_control.h>

#include <cstddef>
#include <memory>

#include "format/base/option_row.h"
#include "tools/report/progress.h"

namespace CLI {
class App;
}

namespace weir {

/// Adds --memory and --threads, which go to `given`, --progress and --progress-fd; both must live as long as the
/// command.
void add_run_options(CLI::App& command, GivenOptions& given, ProgressOptions& progress);

/// Keeps TBB to `asked` threads while it lives, 0: to the machine's, and to fewer where no more can be started, with a
/// warning. Throws Error(io) where none can.
std::unique_ptr<tbb::global_control> limit_threads(std::size_t asked);

}  // namespace weir
