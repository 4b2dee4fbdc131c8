// The command's options, as the Python side writes them from keywords: "--rate=8". One set of names, checks and
// messages for both.
#pragma once

#include <string>
#include <vector>

namespace weir::python {

/// Parses `options` with what was added to `command`. Throws Error(usage) with the first line of what is wrong.
void parse_options(CLI::App& command, std::vector<std::string> options);

}  // namespace weir::python
