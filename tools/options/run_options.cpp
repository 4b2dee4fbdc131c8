#include "tools/options/run_options.h"

#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>

#include "compressor/plan/memory_plan.h"
#include "compressor/plan/startable_threads.h"
#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {

void add_run_options(CLI::App& command, RunArguments& arguments) {
  command.add_option("--memory", arguments.memory, "ceiling of the whole process; default 512MiB")
      ->type_name("SIZE")
      ->group("Run");
  command
      .add_option("--threads", arguments.threads,
                  "0: all of the machine's, for convert as many of them as --memory holds")
      ->check(CLI::Range(0, 4096))
      ->type_name("N")
      ->group("Run")
      ->capture_default_str();
  add_progress_options(command, arguments.progress);
}

std::uint64_t parse_memory(const RunArguments& arguments) {
  if (arguments.memory.empty()) return kDefaultMemory;
  const auto bytes = parse_bytes(arguments.memory);
  if (!bytes || *bytes < kLeastMemory) {
    throw Error(ErrorKind::usage, cat("--memory is \"", arguments.memory, "\", it must be a size of at least ",
                                      format_bytes(kLeastMemory), ", like 512MiB"));
  }
  return *bytes;
}

std::unique_ptr<tbb::global_control> limit_threads(int asked) {
  const std::size_t threads = processors_or_all(static_cast<std::size_t>(asked));
  return std::make_unique<tbb::global_control>(
      tbb::global_control::max_allowed_parallelism,
      startable_workers(threads, [](const std::string& line) { spdlog::warn("{}", line); }));
}

}  // namespace weir
