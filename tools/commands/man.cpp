// weir man, hidden: writes the manual pages, for the installation, and docs/options.md.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <system_error>

#include "format/base/error.h"
#include "ingest/source/convert_command.h"
#include "tools/command.h"
#include "tools/describe/config_page.h"
#include "tools/describe/man_page.h"
#include "tools/describe/options_page.h"

namespace weir {
namespace {

struct ManArguments {
  std::string directory;
  bool options = false;
};

void write_page(const std::filesystem::path& path, const std::string& page) {
  std::ofstream file(path);
  file << page;
  file.close();
  if (!file) throw Error(ErrorKind::io, cat(path.string(), ": cannot be written; name a directory that can"));
}

void write_pages(CLI::App& app, const std::filesystem::path& directory) {
  std::error_code ignored;
  if (!std::filesystem::exists(directory, ignored)) {
    throw Error(ErrorKind::io, cat(directory.string(), ": this directory does not exist; make it: mkdir -p ",
                                   shell_word(directory.string())));
  }
  const std::vector<CommandDescription> commands = describe_commands(app);
  for (const CommandDescription& c : commands) {
    write_page(directory / (man_page_name(c) + ".1"), man_page(c, commands, WEIR_VERSION));
  }
  write_page(directory / "weir.toml.5", config_page(WEIR_VERSION));
}

}  // namespace

void add_man(CLI::App& app) {
  auto a = std::make_shared<ManArguments>();
  CLI::App* command =
      app.add_subcommand("man", "Writes a manual page for weir, for each of its commands and for weir.toml");
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
