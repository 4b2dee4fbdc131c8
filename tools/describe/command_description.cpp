#include "tools/describe/command_description.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "format/base/text.h"

namespace weir {
namespace {

/// Returns the texts that follow the placeholder in an option's type, one for each check of its value, the last check
/// first: "{a,b,c}", "INT in [0 - 9]".
std::vector<std::string> checks_of(CLI::Option& option) {
  std::vector<std::string> checks;
  try {
    for (int i = 0;; ++i) checks.push_back(option.get_validator(i)->get_description());
  } catch (const CLI::OptionNotFound&) {  // CLI11 throws this when there are no more checks
  }
  std::reverse(checks.begin(), checks.end());
  return checks;
}

void describe_value(CLI::Option& option, OptionDescription& description) {
  if (option.get_type_size() == 0) return;
  std::string placeholder = option.get_type_name();
  for (const std::string& check : checks_of(option)) {
    const std::string suffix = ":" + check;
    if (!check.empty() && placeholder.ends_with(suffix)) placeholder.resize(placeholder.size() - suffix.size());
    if (check.starts_with('{') && check.ends_with('}')) {
      description.choices = split(check.substr(1, check.size() - 2), ',');
    }
  }
  if (!description.choices.empty()) {
    placeholder.clear();
    for (const std::string& choice : description.choices) placeholder += cat(placeholder.empty() ? "" : "|", choice);
  } else if (placeholder.find('|') != std::string::npos) {
    description.choices = split(placeholder, '|');
  }
  description.argument = placeholder;
  description.default_value = option.get_default_str();
}

OptionDescription describe(CLI::Option& option) {
  OptionDescription description;
  description.positional = option.get_positional();
  if (description.positional) {
    description.names = {option.get_name(true)};
  } else {
    for (const std::string& name : option.get_snames()) description.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) description.names.push_back("--" + name);
  }
  description.text = option.get_description();
  description.group = option.get_group();
  description.required = option.get_required();
  description.repeated = option.get_expected_max() > 1;
  describe_value(option, description);
  return description;
}

CommandDescription describe(CLI::App& command) {
  CommandDescription description{command.get_name(), command.get_description(), command.get_footer(), {}};
  if (description.text.ends_with('.')) description.text.pop_back();
  while (description.footer.ends_with('\n')) description.footer.pop_back();
  for (CLI::Option* option : command.get_options([](const CLI::Option*) { return true; })) {
    if (!option->get_group().empty()) description.options.push_back(describe(*option));
  }
  return description;
}

}  // namespace

std::vector<CommandDescription> describe_commands(CLI::App& app) {
  std::vector<CommandDescription> commands{describe(app)};
  for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (!command->get_group().empty()) commands.push_back(describe(*command));
  }
  return commands;
}

}  // namespace weir
