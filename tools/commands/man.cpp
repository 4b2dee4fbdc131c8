// weir man, hidden: writes the manual pages, for the installation.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "format/base/error.h"
#include "format/base/text.h"
#include "tools/command.h"
#include "tools/describe/man_page.h"

namespace weir {

void add_man(CLI::App& app) {
  auto directory = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("man", "Writes a manual page for weir and for each of its commands");
  command->group("");
  command->add_option("directory", *directory, "where weir.1, weir-convert.1 and so on go")->required();
  command->callback([&app, directory] {
    const std::vector<CommandDescription> commands = describe_commands(app);
    for (const CommandDescription& c : commands) {
      const std::string path = (std::filesystem::path(*directory) / (man_page_name(c) + ".1")).string();
      std::ofstream file(path);
      file << man_page(c, commands, WEIR_VERSION);
      file.close();
      if (!file) throw Error(ErrorKind::io, cat(path, ": cannot be written; name a directory that can"));
    }
  });
}

}  // namespace weir
