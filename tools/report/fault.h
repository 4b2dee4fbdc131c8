// The message and exit code for an exception that is not an Error.
#pragma once

#include <exception>
#include <string>
#include <string_view>

namespace weir {

struct Fault {
  std::string message;
  int exit_code = 0;
};

/// Returns the message and exit code for `error`. A lack of memory or threads is blamed on the machine, everything
/// else on weir. `smaller`: what to reduce when memory is short, for instance "--memory".
Fault fault_of(const std::exception& error, std::string_view smaller);

}  // namespace weir
