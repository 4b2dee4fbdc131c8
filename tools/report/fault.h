// What a command says of an exception that is no Error, and what it ends with.
#pragma once

#include <exception>
#include <string>
#include <string_view>

namespace weir {

struct Fault {
  std::string message;
  int exit_code = 0;
};

/// No memory and no more threads are of the machine, all else is a fault of weir. `smaller`: what to make smaller where
/// there is no memory, "--memory" for instance.
Fault fault_of(const std::exception& error, std::string_view smaller);

}  // namespace weir
