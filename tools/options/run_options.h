// How a command may use the machine: the same options for every command that
// streams a volume.
#pragma once

#include <oneapi/tbb/global_control.h>

#include <cstdint>
#include <memory>
#include <string>

#include "tools/report/progress.h"

namespace CLI {
class App;
}

namespace weir {

inline constexpr std::uint64_t kDefaultMemory = std::uint64_t{512} << 20U;
/// Program, libraries and threads' stacks take most of this; less leaves nothing to work in.
inline constexpr std::uint64_t kLeastMemory = std::uint64_t{64} << 20U;

struct RunArguments {
  std::string memory;  ///< a size, of the whole process; empty: kDefaultMemory
  int threads = 0;     ///< 0: all of the machine's
  ProgressOptions progress;
};

/// Adds --memory, --threads, --progress and --progress-fd, stored in `arguments`, which must live as long as the
/// command.
void add_run_options(CLI::App& command, RunArguments& arguments);

/// Bytes. Throws Error(usage) where the text is no size or below kLeastMemory.
std::uint64_t parse_memory(const RunArguments& arguments);

/// Keeps TBB to `asked` threads while it lives, 0: to the machine's, and to fewer where no more can be started, with a
/// warning. Throws Error(io) where none can.
std::unique_ptr<tbb::global_control> limit_threads(int asked);

}  // namespace weir
