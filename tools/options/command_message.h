// An error in the words of the command that it ended.
#pragma once

#include <string>

#include "format/base/error.h"

namespace CLI {
class App;
}

namespace weir {

/// One line: error.what(), but that its remedy of a full disk names only options that the command has which `app`
/// parsed; and with the remedy of an input that is not there, where its name is relative.
std::string command_message(const CLI::App& app, const Error& error);

}  // namespace weir
