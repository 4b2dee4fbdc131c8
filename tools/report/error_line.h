// What goes wrong, as a command says it.
#pragma once

#include <string>

namespace weir {

/// Writes "weir: MESSAGE" to stderr as one line: paths are what the user gave or a file said, and control characters
/// must neither break the line nor steer the terminal.
void print_error_line(const std::string& message);

}  // namespace weir
