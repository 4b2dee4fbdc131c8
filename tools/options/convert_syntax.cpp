#include "tools/options/convert_syntax.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>
#include <vector>

#include "format/base/error.h"
#include "tools/options/conversion_options.h"
#include "tools/options/input_options.h"
#include "tools/options/run_options.h"

namespace weir {
namespace {

/// Those options of a command line, and nothing else.
struct WatchedConversion {
  WatchedConversion() {
    add_input_options(command, input);
    add_conversion_options(command, conversion);
    // A stack is many files; the job of a watch is one.
    command.remove_option(command.get_option("--stack"));
    command.set_help_flag();
  }
  CLI::App command;
  InputArguments input;
  ConversionArguments conversion;
};

void check(std::vector<std::string> arguments) {
  WatchedConversion given;
  std::reverse(arguments.begin(), arguments.end());  // as CLI11 wants them
  try {
    given.command.parse(std::move(arguments));
  } catch (const CLI::ParseError& error) {
    throw Error(ErrorKind::usage, error.what());
  }
  parse_input(given.input);
  parse_conversion(given.conversion);
}

}  // namespace

ConvertSyntax convert_syntax() {
  ConvertSyntax syntax;
  const WatchedConversion all;
  for (const CLI::Option* option : all.command.get_options()) {
    const std::string& name = option->get_lnames().front();
    syntax.options.push_back({name, option->get_expected_max() == 0, name == "scene"});
  }
  syntax.check = check;
  syntax.least_memory = kLeastMemory;
  return syntax;
}

}  // namespace weir
