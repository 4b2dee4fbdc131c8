// The message for a command line that does not parse: the wrong word, the word that may have been meant, and the help
// that applies.
#pragma once

#include <string>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace weir {

/// Returns one line that explains `error` of the command line that `app` parsed: "no command \"covnert\"; did you mean
/// convert? see weir --help".
std::string parse_message(const CLI::App& app, const CLI::ParseError& error);

}  // namespace weir
