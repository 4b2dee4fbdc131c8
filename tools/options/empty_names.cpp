#include "tools/options/empty_names.h"

#include <CLI/CLI.hpp>
#include <string>

#include "format/base/error.h"

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

}  // namespace weir
