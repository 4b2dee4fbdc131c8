#include "daemon/disks/output_mounts.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "tests/support/temporary_directory.h"

namespace weir::output_mounts_test {
namespace {

class OutputMountsTest : public testing::Test {
 protected:
  std::set<std::string> mounted_;
  EventLog log_{ServiceConfig{}};
  OutputMounts mounts_{log_, [this](const std::string& path) { return mounted_.contains(path); }};
};

TEST_F(OutputMountsTest, NoPath_IsMounted) {
  EXPECT_TRUE(mounts_.mounted(""));
  EXPECT_TRUE(mounts_.all_mounted());
}

TEST_F(OutputMountsTest, MissingOnes_AreNamedUntilALookFindsThem) {
  mounted_ = {"/c"};
  EXPECT_FALSE(mounts_.mounted("/b"));
  EXPECT_FALSE(mounts_.mounted("/a"));
  EXPECT_TRUE(mounts_.mounted("/c"));
  EXPECT_EQ(mounts_.text(), "no file system is mounted at /a; no file system is mounted at /b");
  mounted_ = {"/a"};
  mounts_.look();
  EXPECT_EQ(mounts_.text(), "no file system is mounted at /b") << "/c is not used now, so nobody looked at it";
  EXPECT_FALSE(mounts_.all_mounted());
  mounted_ = {"/a", "/b"};
  EXPECT_TRUE(mounts_.mounted("/b"));
  EXPECT_TRUE(mounts_.all_mounted());
  EXPECT_EQ(mounts_.text(), "");
}

TEST_F(OutputMountsTest, MountsThatTheConfigurationDropped_AreForgotten) {
  mounts_.mounted("/a");
  mounts_.mounted("/b");
  mounts_.keep({"", "/b"});
  EXPECT_EQ(mounts_.text(), "no file system is mounted at /b");
}

}  // namespace
}  // namespace weir::output_mounts_test
