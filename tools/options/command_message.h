// An error in the words of the command that it ended.
#pragma once

#include <string>

#include "format/base/error.h"

namespace CLI {
class App;
}

namespace weir {

/// One line: error.what(), but that its remedy of a full disk names only options that the command has which `app`
/// parsed.
std::string command_message(const CLI::App& app, const Error& error);

}  // namespace weir
