#include "tests/support/run_command.h"

#include <gtest/gtest.h>

#include <csignal>
#include <system_error>
#include <thread>

namespace weir::run_command_test {
namespace {

using std::chrono::milliseconds;
using Names = std::vector<std::string>;

TEST(RunCommand, KeepsTheStreamsApartAndTheExitCode) {
  const CommandResult result = run_command({"sh", "-c", "echo to out; echo to err >&2; exit 7"});
  EXPECT_EQ(result.exit_code, 7);
  EXPECT_EQ(result.out, "to out\n");
  EXPECT_EQ(result.err, "to err\n");
  EXPECT_FALSE(result.timed_out);
  EXPECT_GT(result.peak_rss_bytes, 0u);
}

TEST(RunCommand, TakesOutputLargerThanAPipeHolds) {
  const CommandResult result = run_command({"sh", "-c", "head -c 1000000 /dev/zero"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out, std::string(1000000, '\0'));
}

TEST(RunCommand, StandardInputIsEmpty) { EXPECT_EQ(run_command({"wc", "-c"}).out, "0\n"); }

TEST(RunCommand, AppliesDirectoryAndEnvironment) {
  const TemporaryDirectory directory;
  CommandOptions options;
  options.directory = directory.path();
  options.environment = {"HOME=/elsewhere"};
  EXPECT_EQ(run_command({"sh", "-c", "echo \"$HOME\" \"$(pwd -P)\""}, options).out,
            "/elsewhere " + std::filesystem::canonical(directory.path()).string() + "\n");
}

TEST(RunCommand, KillsTheWholeGroupAtTheTimeout) {
  CommandOptions options;
  options.timeout = milliseconds(100);
  const auto start = std::chrono::steady_clock::now();
  const CommandResult result = run_command({"sh", "-c", "sleep 60 & sleep 60"}, options);
  EXPECT_TRUE(result.timed_out);
  EXPECT_EQ(result.exit_code, 128 + SIGKILL);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
}

TEST(RunCommand, SaysWhatCannotBeStarted) {
  try {
    run_command({"/nonexistent/program"});
    FAIL() << "started";
  } catch (const std::system_error& error) {
    EXPECT_EQ(error.code().value(), ENOENT);
    EXPECT_NE(std::string(error.what()).find("start /nonexistent/program"), std::string::npos) << error.what();
  }
}

TEST(ChildProcess, TakesSignalsWhileItsOutputIsRead) {
  ChildProcess child({"sh", "-c", "trap 'echo caught; exit 130' INT; echo ready; while :; do sleep 0.01; done"});
  while (child.running() && child.out_so_far() != "ready\n") std::this_thread::sleep_for(milliseconds(1));
  child.send_signal(SIGINT);
  const CommandResult result = child.wait();
  EXPECT_EQ(result.exit_code, 130);
  EXPECT_EQ(result.out, "ready\ncaught\n");
  child.send_signal(SIGINT);  // after the end: nothing to signal, nothing to say
}

TEST(TemporaryDirectory, ListsItsFilesAndIsRemovedAtTheEnd) {
  std::filesystem::path path;
  {
    const TemporaryDirectory directory;
    path = directory.path();
    EXPECT_EQ(list_directory(path), Names{});
    std::filesystem::create_directory(directory / "sub");
    write_file(directory / "sub/.hidden", std::string("a\0b", 3));
    write_file(directory / "b", "");
    EXPECT_EQ(list_directory(path), (Names{"b", "sub/", "sub/.hidden"}));
    EXPECT_EQ(read_file(directory / "sub/.hidden"), std::string("a\0b", 3));
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace weir::run_command_test
