// Tests files that a source names. On the command line any file is read, with a notice if it lies elsewhere; with
// --within and in a watch, only files below a directory are read.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/support/python.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_directory.h"

namespace weir::followed_files_test {
namespace {

namespace fs = std::filesystem;

class FollowedFiles : public ::testing::Test {
 protected:
  FollowedFiles() {
    fs::create_directories(directory_ / "run/sub");
    fs::create_directory(directory_ / "elsewhere");
    for (const char* place : {"run/data.raw", "run/sub/data.raw", "elsewhere/data.raw"}) {
      write_file(directory_ / place, std::string(std::size_t{16} * 16 * 16, '\1'));
    }
  }

  /// Converts run/a.mhd; its values are in the file named `data`.
  CommandResult convert(const std::string& data, const std::vector<std::string>& options = {}) const {
    write_file(
        header_,
        "ObjectType = Image\nNDims = 3\nDimSize = 16 16 16\nElementType = MET_UCHAR\nElementDataFile = " + data + "\n");
    std::vector<std::string> command{"convert",     header_,      "-o",          output_,
                                     "--overwrite", "--lossless", "--log-level", "warn"};
    command.insert(command.end(), options.begin(), options.end());
    return run_weir(command);
  }
  std::string refusal(const std::string& outside) const {
    return "weir: " + header_ + ": lies in " + outside + ", outside " + (directory_ / "run") +
           "; move it there, or convert it without --within, in a watch with follow = \"anywhere\"\n";
  }

  TemporaryDirectory directory_;
  std::string header_ = directory_ / "run/a.mhd";
  std::string output_ = directory_ / "out.nvdb";
  std::string far_ = fs::canonical(directory_.path()).string() + "/elsewhere/data.raw";
  std::vector<std::string> within_{"--within", directory_ / "run"};
};

TEST_F(FollowedFiles, BesideTheHeaderOrBelow_AreReadWithoutANotice) {
  for (const char* data : {"data.raw", "sub/data.raw"}) {
    for (const auto& options : {std::vector<std::string>{}, within_}) {
      const CommandResult result = convert(data, options);
      EXPECT_EQ(result.exit_code, 0);
      EXPECT_EQ(result.err, "");
    }
  }
}

TEST_F(FollowedFiles, Elsewhere_IsANoticeOnTheCommandLine) {
  const CommandResult result = convert("../elsewhere/data.raw");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.err.find(header_ + ": lies in " + far_ + ", outside the directory of this file\n"),
            std::string::npos)
      << result.err;
  EXPECT_TRUE(fs::exists(output_));
}

TEST_F(FollowedFiles, OutsideTheDirectoryAsked_AreRefused) {
  const CommandResult result = convert("../elsewhere/data.raw", within_);
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.err, refusal(far_));
  EXPECT_FALSE(fs::exists(output_));
}

TEST_F(FollowedFiles, ALinkThatLeadsOutside_IsRefused) {
  fs::create_symlink("../elsewhere/data.raw", directory_ / "run/link.raw");
  EXPECT_EQ(convert("link.raw", within_).err, refusal(far_));
  fs::create_directory_symlink("../elsewhere", directory_ / "run/there");
  EXPECT_EQ(convert("there/data.raw", within_).err, refusal(far_));
  fs::create_symlink("sub/data.raw", directory_ / "run/inside.raw");
  EXPECT_EQ(convert("inside.raw", within_).exit_code, 0);
}

TEST_F(FollowedFiles, ADirectoryWhoseNameBeginsTheSame_IsOutside) {
  fs::create_directory(directory_ / "run2");
  fs::rename(directory_ / "elsewhere/data.raw", directory_ / "run2/data.raw");
  EXPECT_EQ(convert("../run2/data.raw", within_).err,
            refusal(fs::canonical(directory_.path()).string() + "/run2/data.raw"));
}

TEST_F(FollowedFiles, FilesOfHdf5DatasetsOutside_AreRefused) {
  const std::string make =
      "import h5py, numpy, sys\n"
      "d = sys.argv[1]\n"
      "with h5py.File(d + '/run/external.h5', 'w') as f:\n"
      "    f.create_dataset('v', (16, 16, 16), 'u1', external=[('../elsewhere/data.raw', 0, 4096)])\n"
      "with h5py.File(d + '/elsewhere/source.h5', 'w') as f:\n"
      "    f['w'] = numpy.ones((16, 16, 16), 'u1')\n"
      "with h5py.File(d + '/run/virtual.h5', 'w') as f:\n"
      "    layout = h5py.VirtualLayout((16, 16, 16), 'u1')\n"
      "    layout[...] = h5py.VirtualSource('../elsewhere/source.h5', 'w', (16, 16, 16))\n"
      "    f.create_virtual_dataset('v', layout)\n";
  if (run_command({kPython, "-c", "import h5py"}).exit_code != 0) GTEST_SKIP() << "it needs python3-h5py";
  CommandOptions there;
  there.directory = directory_ / "run";
  ASSERT_EQ(run_command({kPython, "-c", make, directory_.path().string()}, there).exit_code, 0);
  for (const auto& [name, target] : {std::pair{"external.h5", "data.raw"}, {"virtual.h5", "source.h5"}}) {
    const std::string input = directory_ / (std::string("run/") + name);
    const CommandResult result = run_weir({"convert", input, "-o", output_, "--within", directory_ / "run"});
    EXPECT_EQ(result.exit_code, 3) << name;
    EXPECT_NE(result.err.find(std::string("/elsewhere/") + target + ", outside "), std::string::npos) << result.err;
  }
}

TEST_F(FollowedFiles, ADirectoryThatIsNotThere_IsAWrongArgument) {
  const CommandResult result = convert("data.raw", {"--within", directory_ / "no"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.err, "weir: --within is \"" + (directory_ / "no") +
                            "\", which does not exist; name a directory; see weir convert --help\n");
}

}  // namespace
}  // namespace weir::followed_files_test
