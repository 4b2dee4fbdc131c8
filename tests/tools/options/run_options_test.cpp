#include "tools/options/run_options.h"

#include <gtest/gtest.h>
#include <CLI/CLI.hpp>

#include "format/base/error.h"

namespace weir::run_options_test {
namespace {

RunArguments parse(const std::string& command_line) {
  CLI::App app;
  RunArguments arguments;
  add_run_options(app, arguments);
  app.parse(command_line);
  return arguments;
}

TEST(RunOptions, Defaults) {
  const RunArguments arguments = parse("");
  EXPECT_EQ(parse_memory(arguments), 536870912U);
  EXPECT_EQ(arguments.threads, 0);
  EXPECT_EQ(arguments.progress.mode, ProgressMode::automatic);
}

TEST(RunOptions, MemoryTakesASizeOfAtLeast64MiB) {
  EXPECT_EQ(parse_memory(parse("--memory 3GiB")), std::uint64_t{3} << 30U);
  EXPECT_EQ(parse_memory(parse("--memory 64MiB")), std::uint64_t{64} << 20U);
  for (const std::string text : {"63MiB", "much", "-1GiB"}) {
    try {
      parse_memory(parse("--memory=" + text));
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::usage);
      EXPECT_EQ(error.what(), "--memory is \"" + text + "\", it must be a size of at least 64.0 MiB, like 512MiB");
    }
  }
}

TEST(RunOptions, ThreadsLimitTheWorkers) {
  for (const int threads : {1, 2}) {
    const auto limit = limit_threads(parse("--threads " + std::to_string(threads)).threads);
    EXPECT_EQ(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism), threads);
  }
  EXPECT_THROW(parse("--threads -1"), CLI::ValidationError);
}

}  // namespace
}  // namespace weir::run_options_test
