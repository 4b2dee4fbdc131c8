// Declarations that all subcommands share. Each subcommand is one file with one function `add_NAME(CLI::App&)`, which
// main.cpp calls.
#pragma once

#include <atomic>

namespace CLI {
class App;
}

namespace weir {

/// Returns the flag that SIGINT, SIGTERM and SIGHUP set (main.cpp); long work checks it between blocks.
const std::atomic<bool>& interrupt_flag();

/// Adds --log-level and --quiet, which take effect when they are parsed.
void add_log_level(CLI::App& command);

// Each function adds its subcommand to `app`. The subcommand's callback does the work. The callback throws Error for
// every failure, and weir::ExitStatus (below) to end with a code and no message.
void add_convert(CLI::App& app);
void add_compare(CLI::App& app);
void add_flip(CLI::App& app);
void add_export(CLI::App& app);
void add_inspect(CLI::App& app);
void add_verify(CLI::App& app);
void add_render(CLI::App& app);
void add_play(CLI::App& app);
void add_view(CLI::App& app);
void add_sample(CLI::App& app);
void add_sweep(CLI::App& app);
void add_watch(CLI::App& app);
void add_jobs(CLI::App& app);
void add_status(CLI::App& app);
void add_retry(CLI::App& app);
void add_cancel(CLI::App& app);
void add_pause(CLI::App& app);
void add_resume(CLI::App& app);
void add_completion(CLI::App& app);
void add_man(CLI::App& app);

/// Thrown by a subcommand that has already printed its findings (verify, compare).
struct ExitStatus {
  int code;
};

}  // namespace weir
