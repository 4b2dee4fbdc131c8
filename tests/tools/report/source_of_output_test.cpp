// Tests for `weir convert --skip-done` to which source a result belongs.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "format/base/text.h"
#include "tests/support/run_command.h"

namespace weir::source_of_output_test {
namespace {

namespace fs = std::filesystem;

class SourceOfOutput : public testing::Test {
 protected:
  SourceOfOutput() { write_source('\3'); }

  void write_source(char seed) const {
    std::string bytes(40 * 32 * 24, '\0');
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * static_cast<unsigned char>(seed));
    write_file(source_, bytes);
  }
  CommandResult weir_in(const std::string& directory, const std::vector<std::string>& arguments) const {
    CommandOptions options;
    options.directory = directory_.path() / directory;
    return run_weir(arguments, options);
  }

  TemporaryDirectory directory_;
  std::string source_ = directory_ / "v_40x32x24_uint8.raw";
  std::string output_ = directory_ / "v.nvdb";
};

// Two runs of a simulation have files of the same names; a copy may also give them the same times.
TEST_F(SourceOfOutput, FileOfThatNameInAnotherDirectory_IsAnotherSource) {
  const auto convert_in = [&](const std::string& directory) {
    const fs::path run = directory_.path() / directory;
    fs::create_directories(run);
    const std::string name = fs::path(source_).filename().string();
    if (!fs::exists(run / name)) {
      fs::copy_file(source_, run / name);
      fs::last_write_time(run / name, fs::last_write_time(source_));
    }
    return weir_in(directory, {"convert", name, "-o", "../v.nvdb", "--skip-done"});
  };
  ASSERT_EQ(convert_in("a").exit_code, 0);
  const std::string made = read_file(output_);
  const CommandResult other = convert_in("b");
  EXPECT_EQ(other.exit_code, 2) << other.err;
  const std::string real = (fs::canonical(directory_.path()) / "a/v_40x32x24_uint8.raw").string();
  EXPECT_NE(other.err.find(cat("is not of v_40x32x24_uint8.raw (was made of ", real, ")")), std::string::npos)
      << other.err;
  EXPECT_EQ(read_file(output_), made);
  const CommandResult again = convert_in("a");
  EXPECT_NE(again.err.find("done already"), std::string::npos) << again.err;
  const CommandResult absolute =
      weir_in("", {"convert", directory_ / "a/v_40x32x24_uint8.raw", "-o", "v.nvdb", "--skip-done"});
  EXPECT_NE(absolute.err.find("done already"), std::string::npos) << absolute.err;
}

TEST_F(SourceOfOutput, StackInAnotherDirectory_IsAnotherSource) {
  const auto convert_in = [&](const std::string& directory) {
    const fs::path run = directory_.path() / directory;
    fs::create_directories(run);
    for (const char* name : {"p_0.raw", "p_1.raw"}) {
      if (!fs::exists(run / name)) write_file(run / name, std::string(64, directory[0]));
    }
    return weir_in(directory, {"convert", "--stack", "p_%d.raw", "--dims", "8,8,1", "--type", "uint8", "-o",
                               "../v.nvdb", "--skip-done", "--lossless"});
  };
  ASSERT_EQ(convert_in("a").exit_code, 0);
  const CommandResult other = convert_in("b");
  EXPECT_EQ(other.exit_code, 2) << other.err;
  EXPECT_NE(other.err.find("/a/p_0.raw)"), std::string::npos) << other.err;
  EXPECT_NE(convert_in("a").err.find("done already"), std::string::npos);
}

TEST_F(SourceOfOutput, DirectoryThatIsRenamed_HasTheSameSource) {
  const auto convert_in = [&](const std::string& directory) {
    return weir_in(directory, {"convert", fs::path(source_).filename(), "-o", "v.nvdb", "--skip-done"});
  };
  fs::create_directory(directory_.path() / "a");
  fs::copy_file(source_, directory_.path() / "a" / fs::path(source_).filename());
  ASSERT_EQ(convert_in("a").exit_code, 0);
  fs::rename(directory_.path() / "a", directory_.path() / "b");
  const CommandResult again = convert_in("b");
  EXPECT_NE(again.err.find("done already"), std::string::npos) << again.err;
}

// The path is like "latest", a link that leads to another step from time to time.
TEST_F(SourceOfOutput, AbsolutePathThatLeadsToAnotherFile_IsConvertedAgain) {
  const auto lead_to = [&](const std::string& directory) {
    fs::create_directories(directory_.path() / directory);
    fs::copy_file(source_, directory_.path() / directory / "v_40x32x24_uint8.raw",
                  fs::copy_options::overwrite_existing);
    fs::remove(directory_.path() / "latest");
    fs::create_directory_symlink(directory, directory_.path() / "latest");
  };
  const std::string path = directory_ / "latest/v_40x32x24_uint8.raw";
  lead_to("a");
  ASSERT_EQ(run_weir({"convert", path, "-o", output_, "--skip-done"}).exit_code, 0);
  write_source('\5');
  lead_to("b");
  const CommandResult again = run_weir({"convert", path, "-o", output_, "--skip-done"});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_NE(again.err.find("converted again"), std::string::npos) << again.err;
}

}  // namespace
}  // namespace weir::source_of_output_test
