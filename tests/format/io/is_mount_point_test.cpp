#include "format/io/is_mount_point.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/scoped_mount.h"
#include "tests/support/temporary_directory.h"

namespace weir::is_mount_point_test {
namespace {

namespace fs = std::filesystem;

TEST(IsMountPoint, RootsOfFileSystems) {
  EXPECT_TRUE(is_mount_point("/"));
  EXPECT_TRUE(is_mount_point("/proc"));
  EXPECT_TRUE(is_mount_point("/proc/"));
  EXPECT_FALSE(is_mount_point("/proc/self/fd"));
}

TEST(IsMountPoint, DirectoryOfAFileSystem_IsNone) {
  const TemporaryDirectory directory;
  EXPECT_FALSE(is_mount_point(directory.path()));
  EXPECT_FALSE(is_mount_point(directory / "missing"));
}

TEST(IsMountPoint, LinkIsFollowed) {
  const TemporaryDirectory directory;
  fs::create_directory_symlink("/proc", directory / "mounted");
  fs::create_directory_symlink(directory.path(), directory / "plain");
  EXPECT_TRUE(is_mount_point(directory / "mounted"));
  EXPECT_FALSE(is_mount_point(directory / "plain"));
}

TEST(IsMountPoint, DirectoryUnderAMount_BecomesOneAndIsNoneAgain) {
  const TemporaryDirectory directory;
  {
    const ScopedMount mount(directory.path(), 1 << 20);
    if (!mount.refused().empty()) GTEST_SKIP() << mount.refused();
    EXPECT_TRUE(is_mount_point(directory.path()));
  }
  EXPECT_FALSE(is_mount_point(directory.path()));
}

}  // namespace
}  // namespace weir::is_mount_point_test
