#include "tools/options/run_options.h"

#include <gtest/gtest.h>
#include <CLI/CLI.hpp>

#include "compressor/options/conversion_request.h"
#include "tests/support/message_of_error.h"

namespace weir::run_options_test {
namespace {

struct Parsed {
  GivenOptions given;
  ProgressOptions progress;
  ConversionOptions options() const { return read_conversion_request(given).conversion; }
};

Parsed parse(const std::string& command_line) {
  CLI::App app;
  Parsed parsed;
  add_run_options(app, parsed.given, parsed.progress);
  app.parse(command_line);
  return parsed;
}

TEST(RunOptions, Defaults) {
  const Parsed parsed = parse("");
  EXPECT_EQ(parsed.options().memory, 536870912U);
  EXPECT_EQ(parsed.options().threads, 0U);
  EXPECT_EQ(parsed.progress.mode, ProgressMode::automatic);
}

TEST(RunOptions, MemoryTakesASizeOfAtLeast64MiB) {
  EXPECT_EQ(parse("--memory 3GiB").options().memory, std::uint64_t{3} << 30U);
  EXPECT_EQ(parse("--memory 64MiB").options().memory, std::uint64_t{64} << 20U);
  for (const std::string text : {"63MiB", "much", "-1GiB"}) {
    EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { parse("--memory=" + text).options(); }),
              "--memory is \"" + text + "\", it must be a size of at least 64.0 MiB, like 512MiB");
  }
}

TEST(RunOptions, ThreadsLimitTheWorkers) {
  for (const int threads : {1, 2}) {
    const auto limit = limit_threads(parse("--threads " + std::to_string(threads)).options().threads);
    EXPECT_EQ(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism), threads);
  }
  EXPECT_EQ(message_of_error(ErrorKind::usage, [] { parse("--threads -1").options(); }),
            "--threads is \"-1\", it must be a whole number from 0 to 4096");
}

}  // namespace
}  // namespace weir::run_options_test
