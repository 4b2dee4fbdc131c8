// What a process may be denied: file size, open files, memory for all processors, a terminal. One line, the exit code
// of its kind, nothing left.
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/run_command.h"
#include "tests/support/sanitized.h"

namespace weir::process_limits_test {
namespace {

namespace fs = std::filesystem;

class ProcessLimits : public ::testing::Test {
 protected:
  ProcessLimits() { fs::create_directory(directory_ / "out"); }

  std::string volume(std::size_t edge) const {
    const std::string e = std::to_string(edge);
    const std::string path = directory_ / ("v_" + e + "x" + e + "x" + e + "_uint8.raw");
    std::string bytes(edge * edge * edge, '\0');
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * 2654435761U >> 24U);
    write_file(path, bytes);
    return path;
  }
  CommandResult run_limited(const std::string& limit, const std::vector<std::string>& arguments) const {
    std::vector<std::string> command{"bash", "-c", limit + " && exec \"$0\" \"$@\"", WEIR_COMMAND};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return run_command(command);
  }
  std::vector<std::string> left() const { return list_directory(directory_ / "out"); }

  /// A library that changes functions of the system's for a command which is run with it.
  std::vector<std::string> preload(const std::string& source) const {
    const std::string library = directory_ / "instead.so";
    write_file(directory_ / "instead.c", source);
    const CommandResult built = run_command({"cc", "-shared", "-fPIC", "-o", library, directory_ / "instead.c"});
    EXPECT_EQ(built.exit_code, 0) << built.err;
    return {"LD_PRELOAD=" + library};
  }

  TemporaryDirectory directory_;
  std::string output_ = directory_ / "out/v.nvdb";
};

TEST_F(ProcessLimits, FileSize_IsAnIoErrorAndNothingIsLeft) {
  const CommandResult result = run_limited("ulimit -f 16", {"convert", volume(64), "-o", output_, "--lossless"});
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_NE(
      result.err.find(": File too large; raise the limit of file size (ulimit -f) or choose another file system\n"),
      std::string::npos)
      << result.err;
  EXPECT_TRUE(result.err.starts_with("weir: " + (directory_ / "out/"))) << result.err;
  EXPECT_EQ(left(), std::vector<std::string>{});
}

TEST_F(ProcessLimits, OpenFiles_AreAnIoErrorOfAStack) {
  for (const char* name : {"p_0_16x16x8_uint8.raw", "p_1_16x16x8_uint8.raw"}) {
    write_file(directory_ / name, std::string(16 * 16 * 8, '\1'));
  }
  const CommandResult result = run_limited(
      "exec 3>&- 4>&- 5>&-; ulimit -n 4", {"convert", directory_ / "p_%d_16x16x8_uint8.raw", "--stack", "-o", output_});
  EXPECT_EQ(result.exit_code, 5) << result.err;
  EXPECT_NE(result.err.find(": Too many open files; raise the limit of open files (ulimit -n)\n"), std::string::npos)
      << result.err;
  EXPECT_EQ(left(), std::vector<std::string>{});
}

TEST_F(ProcessLimits, NewlineInAPath_KeepsTheErrorOnOneLine) {
  const std::string path = directory_ / "a\nb\x1b[2J_8x8x8_uint8.raw";
  const CommandResult result = run_weir({"convert", path, "-o", output_});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(
      result.err,
      "weir: " + (directory_ / "a\\nb\\x1b[2J_8x8x8_uint8.raw: cannot open for reading: No such file or directory\n"));
}

TEST_F(ProcessLimits, Hangup_EndsWith129AndNothingIsLeft) {
  const std::string path = directory_ / "zeros_1024x1024x1024_uint8.raw";
  write_file(path, "");
  fs::resize_file(path, std::uintmax_t{1} << 30U);
  ChildProcess child({WEIR_COMMAND, "convert", path, "-o", output_, "--threads", "1", "--resume", "off"});
  while (child.running() && left().empty()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  child.send_signal(SIGHUP);
  const CommandResult result = child.wait();
  EXPECT_EQ(result.exit_code, 129);
  EXPECT_EQ(result.err, "weir: interrupted; nothing was written\n");
  EXPECT_EQ(left(), std::vector<std::string>{});
}

TEST_F(ProcessLimits, ManyProcessors_AreUsedAsFarAsTheDefaultCeilingHoldsThem) {
  if (kSanitized) GTEST_SKIP() << kSanitizedSkip;
  const std::string path = volume(64);
  std::string bytes;
  for (const int processors : {1, 8, 128, 512}) {
    CommandOptions options;
    options.environment = preload("int get_nprocs(void) { return " + std::to_string(processors) + "; }\n");
    const CommandResult result = run_weir({"convert", path, "-o", output_, "--overwrite"}, options);
    ASSERT_EQ(result.exit_code, 0) << processors << ": " << result.err;
    const bool fewer = result.err.find(" of " + std::to_string(processors) + " threads; give more to use them all") !=
                       std::string::npos;
    EXPECT_EQ(fewer, processors >= 128) << result.err;
    EXPECT_TRUE(bytes.empty() || bytes == read_file(output_)) << processors;
    bytes = read_file(output_);
  }
  CommandOptions options;
  options.environment = preload("int get_nprocs(void) { return 512; }\n");
  const CommandResult asked = run_weir({"convert", path, "-o", output_, "--overwrite", "--threads", "512"}, options);
  EXPECT_EQ(asked.exit_code, 2);
  EXPECT_NE(asked.err.find(" is too small for this volume with 512 threads; give at least "), std::string::npos);
}

}  // namespace
}  // namespace weir::process_limits_test
