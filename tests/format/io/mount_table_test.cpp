#include "format/io/mount_table.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/support/scoped_mount.h"
#include "tests/support/temporary_directory.h"

namespace weir::mount_table_test {
namespace {

namespace fs = std::filesystem;

const std::string kRoot = "20 1 8:1 / / rw,relatime shared:1 - ext4 /dev/sda1 rw\n";

TEST(MountTable, MountPoint_IsMountedAndDirectoriesBelowItAreNot) {
  const MountTable table(kRoot + "30 20 0:40 / /scratch rw,noatime shared:5 master:2 - lustre mgs:/fs rw\n");
  EXPECT_TRUE(table.mounted("/scratch"));
  EXPECT_TRUE(table.mounted("/scratch/"));
  EXPECT_TRUE(table.mounted("/scratch/../scratch/."));
  EXPECT_FALSE(table.mounted("/scratch/run42"));
  EXPECT_FALSE(table.mounted("/scr"));
  EXPECT_FALSE(MountTable("").mounted("/scratch"));
}

TEST(MountTable, NamesWithSpaces_AreWrittenInOctal) {
  EXPECT_TRUE(MountTable(kRoot + "30 20 0:40 / /my\\040disk\\134 rw - xfs /dev/sdb rw\n").mounted("/my disk\\"));
}

TEST(MountTable, BindMountOfAnotherDirectory_IsMounted) {
  EXPECT_TRUE(MountTable(kRoot + "30 20 8:1 /srv/data /scratch rw - ext4 /dev/sda1 rw\n").mounted("/scratch"));
}

// systemd mounts each of ReadWritePaths= over itself.
TEST(MountTable, MountOfADirectoryOverItself_IsNone) {
  EXPECT_FALSE(MountTable(kRoot + "30 20 8:1 /scratch /scratch rw - ext4 /dev/sda1 rw\n").mounted("/scratch"));
  const std::string home = "25 20 8:2 /@home /home rw - btrfs /dev/sda2 rw\n";
  EXPECT_FALSE(
      MountTable(kRoot + home + "30 25 8:2 /@home/a/b /home/a/b rw - btrfs /dev/sda2 rw\n").mounted("/home/a/b"));
  EXPECT_TRUE(MountTable(kRoot + home).mounted("/home"));
}

TEST(MountTable, MountOverItself_OfAFileSystemMountedThere_IsMounted) {
  const std::string disk = "30 20 0:40 / /scratch rw - lustre mgs:/fs rw\n";
  EXPECT_TRUE(MountTable(kRoot + disk + "31 30 0:40 / /scratch rw - lustre mgs:/fs rw\n").mounted("/scratch"));
}

TEST(MountTable, Autofs_CountsOnceTheFileSystemIsMounted) {
  const std::string automount = "30 20 0:50 / /scratch rw - autofs systemd-1 rw\n";
  EXPECT_FALSE(MountTable(kRoot + automount).mounted("/scratch"));
  EXPECT_TRUE(MountTable(kRoot + automount + "31 30 0:51 / /scratch rw - nfs4 server:/a rw\n").mounted("/scratch"));
}

TEST(MountTable, MountBelowALaterOne_IsHiddenByIt) {
  const MountTable table(kRoot + "30 20 0:40 / /s/run rw - xfs /dev/sdb rw\n31 20 0:41 / /s rw - tmpfs none rw\n");
  EXPECT_FALSE(table.mounted("/s/run"));
  EXPECT_TRUE(table.mounted("/s"));
}

TEST(MountTable, LinkToAMountPoint_IsFollowed) {
  const TemporaryDirectory directory;
  fs::create_directory_symlink("/proc", directory / "mounted");
  fs::create_directory_symlink(directory.path(), directory / "plain");
  EXPECT_TRUE(MountTable::read().mounted(directory / "mounted"));
  EXPECT_FALSE(MountTable::read().mounted(directory / "plain"));
  EXPECT_FALSE(MountTable::read().mounted(directory / "missing"));
}

TEST(MountTable, DirectoryUnderAMount_IsMountedUntilTheMountEnds) {
  const TemporaryDirectory directory;
  EXPECT_FALSE(MountTable::read().mounted(directory.path()));
  {
    const ScopedMount mount(directory.path(), 1 << 20);
    if (!mount.refused().empty()) GTEST_SKIP() << mount.refused();
    EXPECT_TRUE(MountTable::read().mounted(directory.path()));
  }
  EXPECT_FALSE(MountTable::read().mounted(directory.path()));
}

}  // namespace
}  // namespace weir::mount_table_test
