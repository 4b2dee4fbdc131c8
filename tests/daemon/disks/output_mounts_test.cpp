#include "daemon/disks/output_mounts.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace weir::output_mounts_test {
namespace {

class OutputMountsTest : public testing::Test {
 protected:
  void mount(const std::vector<std::string>& paths) {
    lines_ = "1 0 8:1 / / rw - ext4 /dev/sda1 rw\n";
    for (const std::string& path : paths) lines_ += "2 1 8:2 / " + path + " rw - ext4 /dev/sdb1 rw\n";
  }

  std::string lines_;
  EventLog log_{ServiceConfig{}};
  OutputMounts mounts_{log_, [this] { return MountTable(lines_); }};
};

TEST_F(OutputMountsTest, NoPath_IsMounted) {
  mounts_.watch({"", ""});
  EXPECT_TRUE(mounts_.mounted(""));
  EXPECT_TRUE(mounts_.all_mounted());
}

TEST_F(OutputMountsTest, MissingOnes_AreNamedUntilALookFindsThem) {
  mount({"/c"});
  mounts_.watch({"/b", "/c", "/a", "/a"});
  EXPECT_FALSE(mounts_.mounted("/a"));
  EXPECT_TRUE(mounts_.mounted("/c"));
  EXPECT_EQ(mounts_.text(), "no file system is mounted at /a; no file system is mounted at /b");
  mount({"/a", "/c"});
  mounts_.look();
  EXPECT_EQ(mounts_.text(), "no file system is mounted at /b");
  EXPECT_FALSE(mounts_.all_mounted());
  mount({"/a", "/b"});
  mounts_.look();
  EXPECT_EQ(mounts_.text(), "no file system is mounted at /c") << "it went meanwhile";
  lines_.clear();
  mounts_.look();
  EXPECT_EQ(mounts_.text(), "no file system is mounted at /c") << "an unreadable table changes nothing";
}

TEST_F(OutputMountsTest, UnreadableTable_NewPathsCountAsNotMounted) {
  mount({"/a"});
  mounts_.watch({"/a"});
  lines_.clear();
  mounts_.watch({"/a", "/b"});
  EXPECT_EQ(mounts_.text(), "no file system is mounted at /b");
}

TEST_F(OutputMountsTest, PathsThatTheConfigurationDropped_AreForgotten) {
  mount({});
  mounts_.watch({"/a", "/b"});
  mounts_.watch({"/b"});
  EXPECT_EQ(mounts_.text(), "no file system is mounted at /b");
  mounts_.watch({});
  EXPECT_TRUE(mounts_.all_mounted());
}

}  // namespace
}  // namespace weir::output_mounts_test
