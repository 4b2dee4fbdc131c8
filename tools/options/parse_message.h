// What is said of a command line that does not parse: the word that is wrong, the one that may have been meant, and the
// help that applies.
#pragma once

#include <string>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace weir {

/// One line of what `error` says of the command line that `app` parsed: "no command \"covnert\"; did you mean convert?
/// see weir --help".
std::string parse_message(const CLI::App& app, const CLI::ParseError& error);

}  // namespace weir
