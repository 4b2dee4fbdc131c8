// weir watch: runs the daemon in the foreground, or shows what it would do.
#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <memory>
#include <string>

#include "daemon/config/check_access.h"
#include "daemon/config/load_config.h"
#include "daemon/service.h"
#include "format/base/error.h"
#include "tools/command.h"
#include "tools/describe/describe_config.h"

namespace weir {
namespace {

struct WatchArguments {
  std::string config;
  bool check = false;
};

void watch_directories(const CLI::App& command, const WatchArguments& a) {
  const auto load = [&] {
    DaemonConfig config = load_config(a.config);
    const CLI::Option* level = command.get_option("--log-level");
    if (level->count() > 0) config.service.log_level = level->as<std::string>();
    return config;
  };
  if (!a.check) std::signal(SIGHUP, SIG_IGN);  // until the service reloads on it; the start reads everything anyway
  const DaemonConfig config = load();
  if (a.check) std::fputs(describe_config(config).c_str(), stdout);
  check_access(config);
  if (a.check) return;
  // The running program also converts, even if another version has been installed in its place since.
  Service service(load, "/proc/self/exe", WEIR_VERSION);
  if (interrupt_flag()) throw Error(ErrorKind::interrupted, "interrupted before it was ready");
  service.run();
}

}  // namespace

void add_watch(CLI::App& app) {
  CLI::App* command = app.add_subcommand("watch", "Converts what appears in directories, as a configuration says");
  const auto a = std::make_shared<WatchArguments>();
  command->add_option("config", a->config, "what to watch; docs/operations.md has its keys")
      ->type_name("CONFIG.toml")
      ->required();
  command->add_flag("--check", a->check,
                    "only validate the configuration, print what it asks for, and see whether this user may read and "
                    "write where it says");
  add_log_level(*command);
  command->callback([command, a] { watch_directories(*command, *a); });
}

}  // namespace weir
