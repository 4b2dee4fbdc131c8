// What a command line accepts, read from its parser: man pages and shell completion are written from it, so that they
// cannot say anything else.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace weir {

struct OptionDescription {
  std::vector<std::string> names;    ///< with their dashes, the short one first; of a positional its bare name
  std::string argument;              ///< what stands for the value, "SIZE" or "auto|on|off"; empty: a flag
  std::vector<std::string> choices;  ///< all values there are; empty: any
  std::string text;
  std::string default_value;  ///< empty: none, or the text says it
  std::string group;          ///< the heading it stands under, "Options" where none was given
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

/// Of `app` itself and each of its subcommands that is not hidden (in group ""), in their order.
std::vector<CommandDescription> describe_commands(CLI::App& app);

}  // namespace weir
