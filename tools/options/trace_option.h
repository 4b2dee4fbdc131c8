// The option --trace of the commands that read a whole volume.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "format/base/trace.h"

namespace CLI {
class App;
}

namespace weir {

/// Adds --trace FILE, stored in `path`, which must live as long as the command.
void add_trace_option(CLI::App& command, std::string& path);

/// Opens the trace `path`, or returns null if `path` is empty. An existing trace is replaced. Throws Error(usage) if
/// `path` is one of `others` (the files that the command reads or writes) or any existing file that is not a trace;
/// Error(io) if its directory does not exist.
std::unique_ptr<Trace> open_trace(const std::string& path, std::span<const std::string> others);

}  // namespace weir
