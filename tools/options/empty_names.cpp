#include "tools/options/empty_names.h"

#include <CLI/CLI.hpp>
#include <string>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {

void refuse_empty_names(CLI::App& app) {
  for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    for (CLI::Option* given : command->get_options()) {
      const bool output = given->check_lname("output");
      if (!output && !given->get_positional()) continue;
      const Message name = output ? compose(option("output")) : compose("the argument ", given->get_name(true));
      given->check([name](const std::string& text) {
        if (text.empty()) throw usage_error(compose(name, " is empty; give a name"));
        return std::string();
      });
    }
  }
}

void refuse_empty_values(const CLI::App& app, const std::vector<std::string>& words) {
  const CLI::App* command = &app;
  for (const std::string& word : words) {
    if (word == "--") return;  // names of files follow
    if (word.starts_with("-o=")) {
      throw usage_error(cat(word, " is read as the name ", word.substr(2), "; write -o NAME or --output=NAME"));
    }
    if (!word.starts_with("--")) {
      const auto named = app.get_subcommands([&](const CLI::App* some) { return some->get_name() == word; });
      if (command == &app && !named.empty()) command = named.front();
      continue;
    }
    if (!word.ends_with('=') || word.find('=') + 1 != word.size()) continue;
    const std::string name = word.substr(2, word.size() - 3);
    if (command->get_option_no_throw("--" + name) == nullptr) continue;
    throw usage_error(cat("--", name, "= has nothing behind it; give a value, or leave it out"));
  }
}

}  // namespace weir
