// What a program says on stderr: in lines of its own, whatever the paths in them, which are what the user gave or a
// file said. Control characters must neither break a line nor steer the terminal.
#pragma once

#include <string>

namespace weir {

/// Writes "PROGRAM: MESSAGE" to stderr, as one line.
void print_error_line(const std::string& message, const std::string& program = "weir");

/// From now on what is logged goes to stderr, as one line each, with its time and level.
void log_in_lines(const std::string& program);

}  // namespace weir
