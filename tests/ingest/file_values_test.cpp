// Tests which arrays and grids count towards the number of values that a file holds.
#include "ingest/file_values.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/support/run_command.h"
#include "tests/support/temporary_directory.h"

namespace weir::file_values_test {
namespace {

DatasetInfo array(std::vector<std::int64_t> extents, std::int64_t components = 1) {
  DatasetInfo info;
  info.extents = std::move(extents);
  info.type = "float32";
  info.components = components;
  return info;
}

std::uint64_t values(std::vector<DatasetInfo> datasets, const std::string& chosen = "") {
  return values_of(datasets, chosen, true);
}

TEST(FileValues, AreThoseOfAllArrays) {
  EXPECT_EQ(values({array({4, 5, 6})}), 120U);
  EXPECT_EQ(values({array({4, 5, 6}), array({4, 5, 6})}), 240U);
}

TEST(FileValues, AreThoseOfAllPositionsAndComponents) {
  EXPECT_EQ(values({array({10, 4, 5, 6})}), 1200U);
  EXPECT_EQ(values({array({4, 5, 6, 3}, 3)}), 360U) << "components are the last axis";
  EXPECT_EQ(values({array({4, 5, 6}, 3)}), 360U) << "components are no axis";
}

TEST(FileValues, LeaveOutCoordinatesAndSingleNumbers) {
  EXPECT_EQ(values({array({4, 5, 6}), array({6}), array({7}), array({5, 2}), array({})}), 120U);
}

TEST(FileValues, HaveTablesThatAreNoCoordinates) {
  EXPECT_EQ(values({array({4, 5, 6}), array({3})}), 123U);
  EXPECT_EQ(values({array({4, 5, 6}), array({5, 6})}), 150U);
  DatasetInfo records = array({6});
  records.type = "compound of 3 members";
  EXPECT_EQ(values({array({4, 5, 6}), records}), 126U);
}

TEST(FileValues, AnArrayWhoseExtentsAreNotKnownCounts) {
  DatasetInfo unread;
  unread.obstacle = "damaged";
  EXPECT_EQ(values({array({4, 5, 6}), unread}), 121U);
  unread.type = "points";
  EXPECT_EQ(values_of(std::vector{array({4, 5, 6}), unread}, "", false), 121U) << "a grid of OpenVDB";
}

TEST(FileValues, CoarserCopiesCountWhereTheyAreChosen) {
  DatasetInfo coarser = array({2, 2, 3});
  coarser.name = "1";
  coarser.by_name_only = true;
  EXPECT_EQ(values({array({4, 5, 6}), coarser}), 120U);
  EXPECT_EQ(values({array({4, 5, 6}), coarser}, "0\n1"), 132U);
}

TEST(FileValues, MoreThanCanBeCountedAreTheMost) {
  const std::int64_t longest = std::int64_t{1} << 40U;
  EXPECT_EQ(values({array({longest, longest, longest})}), ~std::uint64_t{0});
}

TEST(FileValues, OfAFile) {
  const TemporaryDirectory directory;
  const std::string raw = directory / "a_3x4x5_uint8.raw";
  write_file(raw, std::string(60, 'x'));
  EXPECT_EQ(file_values(raw, {}), 60U);
  EXPECT_EQ(file_values(directory.path().string(), {}), 0U);
  EXPECT_EQ(file_values(directory / "none.vti", {}), 0U);
}

}  // namespace
}  // namespace weir::file_values_test
