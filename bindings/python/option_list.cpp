#include "bindings/python/option_list.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "format/base/error.h"

namespace weir::python {

void parse_options(CLI::App& command, std::vector<std::string> options) {
  std::reverse(options.begin(), options.end());  // as CLI11 takes them
  try {
    command.parse(options);
  } catch (const CLI::ParseError& error) {
    const std::string text = error.what();
    throw Error(ErrorKind::usage, text.substr(0, text.find('\n')));
  }
}

}  // namespace weir::python
