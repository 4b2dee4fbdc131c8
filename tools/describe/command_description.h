// Describes what a command line accepts, read from its parser. Man pages and shell completion are written from this
// description, so that they always agree with the parser.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace weir {

struct OptionDescription {
  std::vector<std::string> names;    ///< with their dashes, the short name first; a positional has its bare name
  std::string argument;              ///< placeholder of the value, "SIZE" or "auto|on|off"; empty: a flag
  std::vector<std::string> choices;  ///< all possible values; empty: any
  std::string text;
  std::string default_value;  ///< empty: no default, or the text names it
  std::string group;          ///< its heading, "Options" by default
  bool positional = false;
  bool required = false;
  bool repeated = false;  ///< takes more than one value
};

struct CommandDescription {
  std::string name;  ///< "weir" or "convert"
  std::string text;
  std::string footer;
  std::vector<OptionDescription> options;
};

/// Returns the descriptions of `app` itself and of each subcommand that is not hidden (in group ""), in their order.
std::vector<CommandDescription> describe_commands(CLI::App& app);

}  // namespace weir
