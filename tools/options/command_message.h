// The text that a command prints for the error that ended it.
#pragma once

#include <string>

#include "format/base/error.h"

namespace CLI {
class App;
}

namespace weir {

/// Returns one line, based on error.what(), for the command that `app` parsed. For a full disk, the suggested remedy
/// names only options that this command has. For a missing input with a relative name, a hint to check the current
/// directory is added.
std::string command_message(const CLI::App& app, const Error& error);

}  // namespace weir
