#include "format/io/real_path.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/support/temporary_directory.h"

namespace weir::real_path_test {
namespace {

TEST(LiesBelow, EmptyDirectory_HasNothingBelowIt) {
  EXPECT_FALSE(lies_below("/a/b", ""));
  EXPECT_FALSE(lies_below("", ""));
}

TEST(LiesBelow, ComponentsAreCompared) {
  EXPECT_TRUE(lies_below("/a/b", "/a"));
  EXPECT_TRUE(lies_below("/a", "/a"));
  EXPECT_TRUE(lies_below("/a", "/"));
  EXPECT_FALSE(lies_below("/ab", "/a"));
  EXPECT_FALSE(lies_below("/a", "/a/b"));
}

TEST(RealPath, LinksAreResolvedAndWhatIsMissingIsKept) {
  const TemporaryDirectory directory;
  const std::filesystem::path real = std::filesystem::canonical(directory.path());
  std::filesystem::create_directory(directory / "a");
  std::filesystem::create_directory_symlink("a", directory / "link");
  EXPECT_EQ(real_path(directory / "link/none"), real / "a/none");
}

TEST(RealPath, PathThatCannotBeLookedAt_IsOnlyMadeNormal) {
  const std::string unusable(300, 'x');
  EXPECT_EQ(real_path("/" + unusable + "/b/../c"), "/" + unusable + "/c");
}

}  // namespace
}  // namespace weir::real_path_test
