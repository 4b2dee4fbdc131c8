#include "tools/view/steps/viewed_files.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/tools/support/converted_volume.h"

namespace weir::viewed_files_test {
namespace {

using Names = std::vector<std::string>;

class ViewedFilesTest : public ConvertedVolume {
 protected:
  Names copies(const std::string& stem) {
    Names names;
    for (const char* number : {"1", "2", "3"}) {
      names.push_back(directory_ / (stem + number + ".nvdb"));
      std::filesystem::copy(volume_, names.back());
    }
    return names;
  }
};

TEST_F(ViewedFilesTest, SeriesOfAFile_KeepsEachStepWithTheFileItIsComparedWith) {
  const Names steps = copies("a_");
  const Names against = copies("b_");
  const ViewedFiles files = find_viewed_files({steps[1], true}, directory_ / "b_*.nvdb");
  EXPECT_EQ(files.steps, (Names{steps[1], steps[0], steps[2]}));
  EXPECT_EQ(files.against, (Names{against[1], against[0], against[2]}));
}

TEST_F(ViewedFilesTest, DamagedFirstSteps_TheFirstThatCanBeReadComesFirst) {
  const Names steps = copies("a_");
  const Names against = copies("b_");
  write_file(steps[0], "no volume");
  write_file(against[1], "no volume");
  ViewedFiles files = find_viewed_files({directory_ / "a_*.nvdb"}, directory_ / "b_*.nvdb");
  const Names faults = begin_with_readable(files);
  ASSERT_EQ(faults.size(), 2U);
  EXPECT_TRUE(faults[0].starts_with(steps[0] + ": ")) << faults[0];
  EXPECT_TRUE(faults[1].starts_with(against[1] + ": ")) << faults[1];
  EXPECT_EQ(files.steps, (Names{steps[2], steps[0], steps[1]}));
  EXPECT_EQ(files.against, (Names{against[2], against[0], against[1]}));
}

TEST_F(ViewedFilesTest, FileOfOtherVoxels_LiesElsewhere) {
  const std::string apart = directory_ / "apart.nvdb";
  const auto made =
      run_weir({"convert", directory_ / "v_40x30x20_float32.raw", "-o", apart, "--lossless", "--origin", "0,0,0.5"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_TRUE(lies_elsewhere(find_viewed_files({volume_}, apart)));
  EXPECT_FALSE(lies_elsewhere(find_viewed_files({volume_}, volume_)));
  EXPECT_FALSE(lies_elsewhere(find_viewed_files({volume_}, "")));
}

}  // namespace
}  // namespace weir::viewed_files_test
