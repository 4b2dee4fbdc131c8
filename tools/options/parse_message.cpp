#include "tools/options/parse_message.h"

#include <CLI/CLI.hpp>

#include <algorithm>

#include "format/base/nearest_name.h"
#include "format/base/text.h"
#include "tools/options/parser_wording.h"

namespace weir {
namespace {

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App* c) { return !c->get_group().empty(); })) {
    names.push_back(command->get_name());
  }
  return names;
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

std::string wrong_name(std::string_view what, const std::string& word, const std::vector<std::string>& names) {
  const std::string meant = nearest_name(word, names);
  return meant.empty() ? cat(what, "; see ") : cat(what, "; did you mean ", meant, "? see ");
}

}  // namespace

std::string parse_message(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<CLI::App*> parsed = app.get_subcommands();
  const CLI::App& command = parsed.empty() ? app : *parsed.front();
  const std::string help = cat(parsed.empty() ? "" : app.get_name() + ' ', command.get_name(), " --help");
  const std::vector<std::string> left = app.remaining(true);
  if (error.get_exit_code() != static_cast<int>(CLI::ExitCodes::ExtrasError) || left.empty()) {
    const std::string text = error.what();
    const auto values_of = [&](const std::string& name) {
      const CLI::Option* const option = command.get_option_no_throw(name);
      return option == nullptr ? std::string() : option->get_type_name();
    };
    return cat(parser_wording(text.substr(0, text.find('\n')), values_of), "; see ", help);
  }
  const auto option = std::ranges::find_if(left, [](const std::string& word) { return word.starts_with('-'); });
  if (option != left.end()) {
    const std::string name = option->substr(0, option->find('='));
    return wrong_name(cat("no option ", name), name, option_names(command)) + help;
  }
  if (!parsed.empty()) return cat("unexpected argument \"", left.front(), "\"; see ", help);
  return wrong_name(cat("no command \"", left.front(), '"'), left.front(), command_names(app)) + help;
}

}  // namespace weir
