#include "tools/options/help_words.h"

#include <CLI/CLI.hpp>

namespace weir {

std::vector<std::string> with_help_option(const CLI::App& app, std::vector<std::string> words) {
  if (words.empty() || words.front() != "help") return words;
  words.erase(words.begin());
  if (words.empty()) return {"--help"};
  const auto commands = app.get_subcommands([&](const CLI::App* command) { return command->get_name() == words[0]; });
  if (!commands.empty()) words.emplace_back("--help");
  return words;
}

}  // namespace weir
