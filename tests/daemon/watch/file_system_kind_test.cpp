#include "daemon/watch/file_system_kind.h"

#include <gtest/gtest.h>
#include <sys/vfs.h>

#include <cstdint>

#include "format/base/error.h"

namespace weir::file_system_kind_test {
namespace {

TEST(FileSystemKind, OnlyKnownLocalFileSystemsSeeAllChanges) {
  const auto kind = [](std::uint64_t type) { return file_system_kind(type); };
  EXPECT_EQ(kind(0xEF53).name, "ext4");
  EXPECT_TRUE(kind(0xEF53).sees_all_changes);
  EXPECT_TRUE(kind(0x9123683E).sees_all_changes);   // btrfs, above 2^31
  EXPECT_FALSE(kind(0x6969).sees_all_changes);      // nfs
  EXPECT_FALSE(kind(0x0BD00BD0).sees_all_changes);  // lustre
  EXPECT_FALSE(kind(0x47504653).sees_all_changes);  // gpfs
  EXPECT_FALSE(kind(0x65735546).sees_all_changes);  // fuse
  EXPECT_FALSE(kind(0xFF534D42).sees_all_changes);  // cifs, above 2^31
  EXPECT_EQ(kind(0xABCDEF01).name, "type 0xABCDEF01");
  EXPECT_FALSE(kind(0xABCDEF01).sees_all_changes);
}

TEST(FileSystemKind, NumberAbove2To31_IsKnownWhereItsTypeIsNegative) {
  struct statfs status {};
  status.f_type = static_cast<std::int32_t>(0x9123683E);
  ASSERT_LT(status.f_type, 0);
  EXPECT_EQ(file_system_kind(status).name, "btrfs");
}

TEST(FileSystemKind, NamesTheFileSystemOfAPath) {
  EXPECT_EQ(file_system_kind("/proc").name, "type 0x9FA0");
  EXPECT_EQ(file_system_kind("/dev/shm").name, "tmpfs");
  try {
    file_system_kind("/no/such/place");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::io);
  }
}

}  // namespace
}  // namespace weir::file_system_kind_test
