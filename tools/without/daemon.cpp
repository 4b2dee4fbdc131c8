// Replaces the service's commands in a build with WEIR_DAEMON=OFF. Each says what is missing.
#include <CLI/CLI.hpp>

#include "format/base/error.h"
#include "tools/command.h"

namespace weir {
namespace {

void add_missing(CLI::App& app, const std::string& name, const std::string& text) {
  CLI::App* command = app.add_subcommand(name, text + " (not in this build)");
  command->allow_extras();
  command->callback([name] {
    throw usage_error(cat(name, ": this weir was built without its service; build it with -DWEIR_DAEMON=ON"));
  });
}

}  // namespace

void add_watch(CLI::App& app) { add_missing(app, "watch", "Converts what appears in directories"); }
void add_view(CLI::App& app) { add_missing(app, "view", "Serves a page that shows NanoVDB files"); }
void add_jobs(CLI::App& app) { add_missing(app, "jobs", "Lists a service's jobs"); }
void add_status(CLI::App& app) { add_missing(app, "status", "Shows what a service does"); }
void add_retry(CLI::App& app) { add_missing(app, "retry", "Has a service convert again"); }
void add_cancel(CLI::App& app) { add_missing(app, "cancel", "Has a service give jobs up"); }
void add_pause(CLI::App& app) { add_missing(app, "pause", "Has a service start no more jobs"); }
void add_resume(CLI::App& app) { add_missing(app, "resume", "Has a paused service start jobs again"); }

}  // namespace weir
