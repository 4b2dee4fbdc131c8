// From what main was given to a parsed command.
#pragma once

namespace CLI {
class App;
}

namespace weir {

/// Parses the words of main by `app`, which has all its subcommands: "help COMMAND" too. Throws CLI::ParseError, and
/// Error(usage) for names and values that are empty and where no command is given.
void parse_command_line(CLI::App& app, int argc, char** argv);

}  // namespace weir
