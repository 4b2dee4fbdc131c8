// The option --trace of the commands that go through a volume.
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

/// Null where `path` is empty; a trace that is there is replaced. Throws Error(usage) where it is one of `others`, the
/// files that the command is about, or any other file that is no trace.
std::unique_ptr<Trace> open_trace(const std::string& path, std::span<const std::string> others);

}  // namespace weir
