// Scripts that let a shell complete a command line.
#pragma once

#include <string>
#include <vector>

#include "tools/describe/command_description.h"

namespace weir {

/// For bash 4 and later: subcommands, options and the values of those that have a list; else file names.
std::string bash_completion(const std::vector<CommandDescription>& commands);
/// For zsh and fish: the same, with what each option does.
std::string zsh_completion(const std::vector<CommandDescription>& commands);
std::string fish_completion(const std::vector<CommandDescription>& commands);

}  // namespace weir
