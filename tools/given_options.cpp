#include "tools/given_options.h"

namespace weir {

std::map<std::string, std::string> given_options(const CLI::App& command) {
  std::map<std::string, std::string> given;
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() == 0 || option->get_lnames().empty()) continue;
    const std::string& name = option->get_lnames().front();
    if (name == "help" || name == "json" || name == "progress" || name == "log-level") continue;
    given[name] = option->get_expected_max() == 0 ? "true" : option->results().back();
  }
  return given;
}

}  // namespace weir
