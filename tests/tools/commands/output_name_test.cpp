// Tests how commands read --output.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/run_command.h"

namespace weir::output_name_test {
namespace {

class OutputName : public testing::Test {
 protected:
  OutputName() { write_file(directory_.path() / "a_4x3x2_uint8.raw", std::string(24, '\1')); }

  CommandResult weir(std::vector<std::string> arguments) const {
    CommandOptions options;
    options.directory = directory_.path();
    return run_weir(std::move(arguments), options);
  }
  void expect_refused(const std::string& output, const std::string& message) const {
    const CommandResult result = weir({"convert", "a_4x3x2_uint8.raw", "-o", output});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.err, "weir: " + message + '\n');
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(list_directory(directory_.path()), std::vector<std::string>{"a_4x3x2_uint8.raw"});
  }

  TemporaryDirectory directory_;
};

TEST_F(OutputName, Dash_IsRefusedAsAVolumeIsNoStream) {
  expect_refused(
      "-",
      "-: cannot write to standard output: the header is written last; name a file, and stream that when it is done");
}

TEST_F(OutputName, Dash_IsNoDirectory) {
  const CommandResult result = weir({"sweep", "a_4x3x2_uint8.raw", "-o", "-"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.err, "weir: -: a directory is to be made, and - means standard output; name it ./- or else\n");
  EXPECT_EQ(list_directory(directory_.path()), std::vector<std::string>{"a_4x3x2_uint8.raw"});
}

TEST_F(OutputName, BytesThatAreNotUtf8_AreReplacedInTheReport) {
  ASSERT_EQ(weir({"convert", "a_4x3x2_uint8.raw", "-o", "v.nvdb"}).exit_code, 0);
  const auto reported = [&](const char* key, const std::vector<std::string>& command) {
    const CommandResult result = weir(command);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const auto report = nlohmann::json::parse(result.out, nullptr, false);
    return report.is_object() ? report.value(key, "none") : "no JSON: " + result.out;
  };
  EXPECT_EQ(reported("image", {"render", "v.nvdb", "-o", "b\xff.png", "--size", "8x8", "--spp", "1", "--json"}),
            "b\xEF\xBF\xBD.png");
  EXPECT_EQ(reported("output", {"sample", "cloud", "--dims", "8,8,8", "-o", "b\xff.raw", "--json"}),
            "b\xEF\xBF\xBD.raw");
  EXPECT_EQ(reported("output", {"play", "v.nvdb", "-o", "b\xff", "--size", "8x8", "--spp", "1", "--json"}),
            "b\xEF\xBF\xBD");
}

TEST_F(OutputName, Vdb_IsRefusedWithTheCommandThatExports) {
  expect_refused(
      "a.vdb",
      "a.vdb: is to be a NanoVDB file, and .vdb is OpenVDB's; name it a.nvdb, and make the OpenVDB file of that "
      "with weir export a.nvdb -o a.vdb");
}

TEST_F(OutputName, ExtensionOfAnotherFormat_IsRefusedInAnyCase) {
  expect_refused("a.VDB",
                 "a.VDB: is to be a NanoVDB file, and .vdb is OpenVDB's; name it a.nvdb, and make the OpenVDB file of "
                 "that with weir export a.nvdb -o a.VDB");
  expect_refused("b.c/a.Png", "b.c/a.Png: is to be a NanoVDB file, and .png is another format's; name it b.c/a.nvdb");
  for (const std::string extension : {"h5", "nc", "raw", "json", "nrrd", "vti", "exr"}) {
    expect_refused("a." + extension, "a." + extension + ": is to be a NanoVDB file, and ." + extension +
                                         " is another format's; name it a.nvdb");
  }
}

TEST_F(OutputName, ExtensionOfNoKnownFormat_IsTaken) {
  for (const char* name : {"a.foo", "a", "a.nvdb.bak", "a.1"}) {
    EXPECT_EQ(weir({"convert", "a_4x3x2_uint8.raw", "-o", name}).exit_code, 0) << name;
  }
}

TEST_F(OutputName, MissingDirectoryWithASlash_IsMade) {
  EXPECT_EQ(weir({"convert", "a_4x3x2_uint8.raw", "-o", "out/"}).exit_code, 0);
  EXPECT_EQ(list_directory(directory_.path() / "out"),
            (std::vector<std::string>{"a_4x3x2_uint8.nvdb", "a_4x3x2_uint8.nvdb.json"}));
}

TEST_F(OutputName, MissingDirectoriesAboveIt_AreMade) {
  EXPECT_EQ(weir({"convert", "a_4x3x2_uint8.raw", "-o", "d/e/f/"}).exit_code, 0);
  EXPECT_EQ(weir({"play", "d/e/f/a_4x3x2_uint8.nvdb", "-o", "p/q/", "--size", "8x8", "--spp", "1"}).exit_code, 0);
  EXPECT_EQ(weir({"sweep", "a_4x3x2_uint8.raw", "--rates", "0.0001", "--methods", "auto", "-o", "s/t//"}).exit_code, 0);
  EXPECT_EQ(list_directory(directory_.path() / "d"),
            (std::vector<std::string>{"e/", "e/f/", "e/f/a_4x3x2_uint8.nvdb", "e/f/a_4x3x2_uint8.nvdb.json"}));
  EXPECT_EQ(list_directory(directory_.path() / "p"), (std::vector<std::string>{"q/", "q/frame_00000.png"}));
  EXPECT_TRUE(std::filesystem::exists(directory_.path() / "s/t/sweep.csv"));
}

TEST_F(OutputName, DirectoriesOfAConversionThatFails_AreNotLeft) {
  std::filesystem::create_directory(directory_.path() / "d");
  EXPECT_EQ(weir({"convert", "missing_4x3x2_uint8.raw", "-o", "d/e/f/"}).exit_code, 3);
  EXPECT_EQ(list_directory(directory_.path()), (std::vector<std::string>{"a_4x3x2_uint8.raw", "d/"}));
}

TEST_F(OutputName, FileAboveTheDirectory_IsRefused) {
  const CommandResult result = weir({"convert", "a_4x3x2_uint8.raw", "-o", "a_4x3x2_uint8.raw/e/f/"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.err, "weir: a_4x3x2_uint8.raw: is no directory; choose another one with -o\n");
}

TEST_F(OutputName, DirectoryOfAConversionThatFails_IsNotLeft) {
  EXPECT_EQ(weir({"convert", "missing_4x3x2_uint8.raw", "-o", "out/"}).exit_code, 3);
  EXPECT_EQ(list_directory(directory_.path()), std::vector<std::string>{"a_4x3x2_uint8.raw"});
}

TEST_F(OutputName, FileWithASlash_IsRefused) {
  write_file(directory_.path() / "out", "precious");
  const CommandResult result = weir({"convert", "a_4x3x2_uint8.raw", "-o", "out/"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.err, "weir: out: is no directory; choose another one with -o\n");
  EXPECT_EQ(read_file(directory_.path() / "out"), "precious");
}

}  // namespace
}  // namespace weir::output_name_test
