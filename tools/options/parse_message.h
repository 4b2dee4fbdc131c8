// What is said of a command line that does not parse: the word that is wrong, the one that may have been meant, and the
// help that applies.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace weir {

/// The one of `names` that takes the fewest slips to become `word`, where a slip is a letter more, less or another, or
/// two neighbours swapped; empty where all take more than one slip in three letters.
std::string nearest_name(std::string_view word, const std::vector<std::string>& names);

/// One line of what `error` says of the command line that `app` parsed: "no command \"covnert\"; did you mean convert?
/// see weir --help".
std::string parse_message(const CLI::App& app, const CLI::ParseError& error);

}  // namespace weir
