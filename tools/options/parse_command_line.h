// Parses the command line that main was given.
#pragma once

namespace CLI {
class App;
}

namespace weir {

/// Parses `argv` with `app`, which already has all its subcommands; accepts "help COMMAND" too. Throws
/// CLI::ParseError, and Error(usage) for an empty name or value or if no command is given.
void parse_command_line(CLI::App& app, int argc, char** argv);

}  // namespace weir
