// weir man, hidden: writes the manual pages, for the installation, and docs/options.md.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "format/base/error.h"
#include "tools/command.h"
#include "tools/describe/man_page.h"
#include "tools/describe/options_page.h"

namespace weir {
namespace {

struct ManArguments {
  std::string directory;
  bool options = false;
};

void write_pages(CLI::App& app, const std::filesystem::path& directory) {
  const std::vector<CommandDescription> commands = describe_commands(app);
  for (const CommandDescription& c : commands) {
    const std::string path = (directory / (man_page_name(c) + ".1")).string();
    std::ofstream file(path);
    file << man_page(c, commands, WEIR_VERSION);
    file.close();
    if (!file) throw Error(ErrorKind::io, cat(path, ": cannot be written; name a directory that can"));
  }
}

}  // namespace

void add_man(CLI::App& app) {
  auto a = std::make_shared<ManArguments>();
  CLI::App* command = app.add_subcommand("man", "Writes a manual page for weir and for each of its commands");
  command->group("");
  CLI::Option* directory = command->add_option("directory", a->directory, "where weir.1, weir-convert.1 and so on go");
  command->add_flag("--options", a->options, "prints docs/options.md instead")->excludes(directory);
  command->callback([&app, a] {
    if (a->options) {
      std::fputs(options_page().c_str(), stdout);
    } else if (a->directory.empty()) {
      throw usage_error("directory is required");
    } else {
      write_pages(app, a->directory);
    }
  });
}

}  // namespace weir
