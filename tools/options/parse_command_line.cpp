#include "tools/options/parse_command_line.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "format/base/error.h"
#include "format/base/text.h"
#include "tools/options/empty_names.h"
#include "tools/options/help_words.h"

namespace weir {

void parse_command_line(CLI::App& app, int argc, char** argv) {
  app.require_subcommand(0, 1);  // a missing command is refused below, after an unknown command was named
  refuse_empty_names(app);
  std::vector<std::string> words = with_help_option(app, {argv + std::min(argc, 1), argv + argc});
  refuse_empty_values(app, words);
  std::ranges::reverse(words);  // CLI11's parse takes them in reverse order
  app.parse(std::move(words));
  if (app.get_subcommands().empty()) throw usage_error(cat("no command given; see ", app.get_name(), " --help"));
}

}  // namespace weir
