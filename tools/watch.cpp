// weir watch: the daemon in the foreground, or what it would do.
#include <cstdio>
#include <memory>
#include <string>

#include "daemon/config.h"
#include "tools/command.h"
#include "tools/convert_syntax.h"
#include "tools/describe_config.h"

namespace weir {
namespace {

struct WatchArguments {
  std::string config;
  bool check = false;
};

void watch_directories(const WatchArguments& a) {
  const DaemonConfig config = load_config(a.config, convert_syntax());
  std::fputs(describe_config(config).c_str(), stdout);
}

}  // namespace

void add_watch(CLI::App& app) {
  CLI::App* command = app.add_subcommand("watch", "Convert what appears in directories, as a configuration says");
  const auto a = std::make_shared<WatchArguments>();
  command->add_option("config", a->config, "CONFIG.toml")->required();
  command->add_flag("--check", a->check, "only validate the configuration and print what it asks for")->required();
  add_log_level(*command);
  command->callback([a] { watch_directories(*a); });
}

}  // namespace weir
