#include "daemon/output_disks.h"

#include <gtest/gtest.h>
#include <sys/statvfs.h>

#include <array>

#include "tests/support/temporary_directory.h"

namespace weir::output_disks_test {
namespace {

using std::chrono::seconds;

TEST(OutputDisks, TellsWhenADiskIsFullAtTheRateOfTheLastMinutes) {
  const TemporaryDirectory directory;
  OutputDisks disks;
  const auto now = std::chrono::steady_clock::now() + seconds(100);
  const std::array<std::string, 3> directories{directory.path() / "a/not/made/yet", directory.path() / "b",
                                               directory.path() / "b"};
  const std::vector<OutputDisk> before = disks.look(directories, now);
  ASSERT_EQ(before.size(), 1U);
  EXPECT_EQ(before[0].directories, (std::vector<std::string>{directories[0], directories[1]}));
  EXPECT_GT(before[0].room.free, 0U);
  EXPECT_GE(before[0].room.total, before[0].room.free);
  EXPECT_EQ(before[0].written_bytes_per_s, 0);
  EXPECT_FALSE(before[0].fills_in_s.has_value());

  disks.written(directories[1], std::uint64_t{1} << 40U, now);
  const std::vector<OutputDisk> after = disks.look(directories, now);
  EXPECT_NEAR(after[0].written_bytes_per_s, 0x1p40 / 100, 0x1p40 / 100 * 0.02);
  ASSERT_TRUE(after[0].fills_in_s.has_value());
  EXPECT_NEAR(*after[0].fills_in_s, static_cast<double>(after[0].room.free) / after[0].written_bytes_per_s,
              *after[0].fills_in_s * 1e-9);
}

TEST(OutputDisks, NamesTheMount) {
  const OutputDisks disks;
  const std::array<std::string, 2> directories{"/proc/self", "/proc/nothing/here"};
  const std::vector<OutputDisk> found = disks.look(directories, std::chrono::steady_clock::now());
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].path, "/proc");
  EXPECT_EQ(found[0].room.total, 0U);
  EXPECT_FALSE(found[0].fills_in_s.has_value());
}

}  // namespace
}  // namespace weir::output_disks_test
