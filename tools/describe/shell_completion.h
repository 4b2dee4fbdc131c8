// Writes scripts with which a shell completes a command line.
#pragma once

#include <string>
#include <vector>

#include "tools/describe/command_description.h"

namespace weir {

/// Returns a script for bash 4 and later. It completes subcommands, options and the values of options that have a
/// list, otherwise file names.
std::string bash_completion(const std::vector<CommandDescription>& commands);
/// Return the same for zsh and fish, with a description of each option.
std::string zsh_completion(const std::vector<CommandDescription>& commands);
std::string fish_completion(const std::vector<CommandDescription>& commands);

}  // namespace weir
