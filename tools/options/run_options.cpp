#include "tools/options/run_options.h"

#include <spdlog/spdlog.h>

#include "compressor/options/conversion_request.h"
#include "compressor/plan/memory_plan.h"
#include "compressor/plan/startable_threads.h"
#include "tools/options/table_options.h"

namespace weir {

void add_run_options(CLI::App& command, GivenOptions& given, ProgressOptions& progress) {
  for (const char* key : {"memory", "threads"}) add_option(command, conversion_option(key), given, "Run");
  add_progress_options(command, progress);
}

std::unique_ptr<tbb::global_control> limit_threads(std::size_t asked) {
  return std::make_unique<tbb::global_control>(
      tbb::global_control::max_allowed_parallelism,
      startable_workers(processors_or_all(asked), [](const Message& line) { spdlog::warn("{}", line.text()); }));
}

}  // namespace weir
