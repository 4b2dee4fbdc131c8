// weir completion: the script that lets a shell complete weir's command lines.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>

#include "tools/command.h"
#include "tools/describe/shell_completion.h"

namespace weir {

void add_completion(CLI::App& app) {
  auto shell = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("completion", "Prints the script that lets a shell complete weir's commands");
  command->add_option("shell", *shell, "for which")->required()->check(CLI::IsMember({"bash", "zsh", "fish"}));
  command->footer(
      "In bash, for this session: source <(weir completion bash). An installed weir has these scripts where bash, zsh\n"
      "and fish look for them.");
  add_log_level(*command);
  command->callback([&app, shell] {
    const std::vector<CommandDescription> commands = describe_commands(app);
    std::cout << (*shell == "bash"  ? bash_completion(commands)
                  : *shell == "zsh" ? zsh_completion(commands)
                                    : fish_completion(commands));
  });
}

}  // namespace weir
