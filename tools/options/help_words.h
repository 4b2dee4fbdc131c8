// Accepts `weir help COMMAND` besides `weir COMMAND --help`.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace weir {

/// Rewrites the words of a command line (without the program's name) that begin with "help": "help" becomes "--help",
/// and "help convert" becomes "convert --help". "help covnert" becomes "covnert", so that the parser suggests a
/// command. Other words are returned unchanged.
std::vector<std::string> with_help_option(const CLI::App& app, std::vector<std::string> words);

}  // namespace weir
