// What every subcommand shares. One subcommand is one file with one
// `add_NAME(CLI::App&)`, listed in main.cpp.
#pragma once

#include <atomic>

namespace CLI {
class App;
}

namespace weir {

/// Set by SIGINT, SIGTERM and SIGHUP (main.cpp); long work looks at it between blocks.
const std::atomic<bool>& interrupt_flag();

/// Adds --log-level and --quiet, applied when they are parsed.
void add_log_level(CLI::App& command);

// Each adds its subcommand to `app`; the work is done in the subcommand's callback, which throws
// Error for everything that goes wrong and weir::ExitStatus (below) to end with a code and no message.
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

/// Thrown by a subcommand that has already said what it found (verify, compare).
struct ExitStatus {
  int code;
};

}  // namespace weir
