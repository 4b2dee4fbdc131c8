// The options --log-level and --quiet, which every command has.
#include <spdlog/spdlog.h>
#include <CLI/CLI.hpp>

#include <string>

#include "tools/command.h"

namespace weir {

void add_log_level(CLI::App& command) {
  command
      .add_option_function<std::string>(
          "--log-level", [](const std::string& level) { spdlog::set_level(spdlog::level::from_str(level)); },
          "trace, debug, info, warn, error or off")
      ->check(CLI::IsMember({"trace", "debug", "info", "warn", "error", "off"}))
      ->default_str("info");
  command.add_flag_callback(
      "-q,--quiet", [] { spdlog::set_level(spdlog::level::err); }, "errors only, and no progress: --log-level error");
}

}  // namespace weir
