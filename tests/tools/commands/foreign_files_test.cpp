// Tests that no command replaces or removes files that are neither weir's own nor its outputs, whatever --overwrite
// says.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/run_command.h"

namespace weir::foreign_files_test {
namespace {

namespace fs = std::filesystem;

class ForeignFiles : public ::testing::Test {
 protected:
  static constexpr std::size_t kVoxels = std::size_t{16} * 16 * 16;

  /// Expects that `arguments` fail with exit code 2 and `line`, and that every file below the directory is unchanged.
  void expect_refused(const std::vector<std::string>& arguments, const std::string& line) const {
    SCOPED_TRACE(line);
    const auto names = list_directory(directory_.path());
    std::vector<std::string> contents;
    for (const std::string& name : names) contents.push_back(content(name));
    const CommandResult result = run_weir(arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.err, "weir: " + line + "\n");
    ASSERT_EQ(list_directory(directory_.path()), names);
    for (std::size_t i = 0; i < names.size(); ++i) EXPECT_EQ(content(names[i]), contents[i]) << names[i];
  }
  std::string content(const std::string& name) const {
    return fs::is_regular_file(fs::path(directory_ / name)) ? read_file(directory_ / name) : std::string();
  }
  static std::string belongs(const std::string& path, const std::string& output) {
    return path + ": belongs to the input, and writing " + output +
           " would replace or remove it; choose another output";
  }

  TemporaryDirectory directory_;
  std::string output_ = directory_ / "v.nvdb";
};

TEST_F(ForeignFiles, InputWithATemporaryName_IsNotTouched) {
  const std::string volume = directory_ / "v_16x16x16_uint8.raw";
  write_file(volume, std::string(kVoxels, '\1'));
  for (const std::string suffix : {".partial", ".json", ".json.partial", ".json.previous"}) {
    const std::string input = output_ + suffix;
    fs::rename(volume, input);
    const std::vector<std::string> command{"convert", input, "-o", output_, "--dims", "16,16,16", "--type", "uint8"};
    expect_refused(command, belongs(input, output_));
    std::vector<std::string> overwriting = command;
    overwriting.emplace_back("--overwrite");
    expect_refused(overwriting, belongs(input, output_));
    fs::rename(input, volume);
  }
}

TEST_F(ForeignFiles, DetachedData_IsNotReplaced) {
  const std::string data = output_ + ".json";
  write_file(data, std::string(kVoxels, '\1'));
  write_file(
      directory_ / "v.mhd",
      "ObjectType = Image\nNDims = 3\nDimSize = 16 16 16\nElementType = MET_UCHAR\nElementDataFile = v.nvdb.json\n");
  expect_refused({"convert", directory_ / "v.mhd", "-o", output_, "--overwrite"}, belongs(data, output_));
}

TEST_F(ForeignFiles, PlaneOfAStack_IsNotReplaced) {
  for (const char* name : {"p_0.slices", "p_1.slices"}) {
    write_file(directory_ / name, std::string(kVoxels / 2, '\1'));
  }
  const std::string plane = directory_ / "p_1.slices";
  expect_refused({"convert", directory_ / "p_%d.slices", "--stack", "--dims", "16,16,8", "--type", "uint8", "-o", plane,
                  "--overwrite"},
                 belongs(plane, plane));
}

TEST_F(ForeignFiles, PipeAndWhatALinkLeadsTo_AreNotReplaced) {
  const std::string volume = directory_ / "v_16x16x16_uint8.raw";
  write_file(volume, std::string(kVoxels, '\1'));
  const std::string reason = ": is no regular file, and nothing else is replaced; choose another output";
  ASSERT_EQ(::mkfifo((directory_ / "pipe").c_str(), 0600), 0);
  expect_refused({"convert", volume, "-o", directory_ / "pipe", "--overwrite"}, directory_ / "pipe" + reason);
  fs::create_symlink("/dev/null", directory_ / "null");
  expect_refused({"convert", volume, "-o", directory_ / "null", "--overwrite"}, directory_ / "null" + reason);
  expect_refused({"sample", "sphere", "--dims", "8,8,8", "-o", directory_ / "pipe", "--overwrite"},
                 directory_ / "pipe" + reason);
}

TEST_F(ForeignFiles, ExportedInput_IsNotTouched) {
  const std::string volume = directory_ / "v_16x16x16_uint8.raw";
  write_file(volume, std::string(kVoxels, '\1'));
  ASSERT_EQ(run_weir({"convert", volume, "-o", output_}).exit_code, 0);
  const std::string input = directory_ / "v.vdb.partial";
  fs::rename(output_, input);
  expect_refused({"export", input, "-o", directory_ / "v.vdb"}, belongs(input, directory_ / "v.vdb"));
}

}  // namespace
}  // namespace weir::foreign_files_test
