// The options that limit how a command uses the machine, the same for every command that streams a volume.
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

/// Adds --memory and --threads, stored in `given`, and --progress and --progress-fd, stored in `progress`. Both must
/// live as long as the command.
void add_run_options(CLI::App& command, GivenOptions& given, ProgressOptions& progress);

/// Limits TBB to `asked` threads while the result lives; 0: as many as the machine has. If the system allows fewer,
/// the limit is lower and a warning is logged. Throws Error(io) if no thread can be started.
std::unique_ptr<tbb::global_control> limit_threads(std::size_t asked);

}  // namespace weir
