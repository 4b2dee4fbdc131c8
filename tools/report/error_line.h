// Messages on stderr, one line each. Paths in a message come from the user or from a file, so control characters must
// neither break a line nor steer the terminal.
#pragma once

#include <string>

namespace weir {

/// Writes "PROGRAM: MESSAGE" to stderr, as one line.
void print_error_line(const std::string& message, const std::string& program = "weir");

/// Sends all later log messages to stderr, one line each, with time and level.
void log_in_lines(const std::string& program);

}  // namespace weir
