// `weir help COMMAND`, for who expects that.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace weir {

/// `words` of a command line, without the program's name, where "help" comes first: "help" is "--help", "help convert"
/// is "convert --help", and "help covnert" is "covnert", which is answered with what may have been meant. Others stay.
std::vector<std::string> with_help_option(const CLI::App& app, std::vector<std::string> words);

}  // namespace weir
