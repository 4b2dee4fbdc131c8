#include "compressor/team/region_share.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/compressor/support/thread_team.h"

namespace weir::region_share_test {
namespace {

TEST(RegionShare, RunsSplitIntoAtMostFiveBoxesInOrder) {
  const Index3 count{3, 4, 5};
  for (std::int64_t begin = 0; begin <= volume(count); ++begin) {
    for (std::int64_t end = begin; end <= volume(count); ++end) {
      const std::vector<Box> boxes = boxes_of_run(count, {begin, end});
      EXPECT_LE(boxes.size(), 5U);
      std::int64_t next = begin;
      for (const Box& box : boxes) {
        for_each_index(box, [&](const Index3& at) { EXPECT_EQ(linear_index(at, count), next++); });
      }
      EXPECT_EQ(next, end);
    }
  }
  EXPECT_EQ(boxes_of_run(count, {0, 60}), (std::vector<Box>{{{0, 0, 0}, count}}));
  EXPECT_EQ(boxes_of_run(count, {1, 30}),
            (std::vector<Box>{
                {{1, 0, 0}, {3, 1, 1}}, {{0, 1, 0}, {3, 4, 1}}, {{0, 0, 1}, {3, 4, 2}}, {{0, 0, 2}, {3, 2, 3}}}));
}

TEST(RegionShare, EachLeafHasExactlyOneOwner) {
  // The domain begins inside one region, below zero, and ends inside another, above zero.
  const NodeLattice leaves = make_lattice({{-140, 5, 100}, {130, 300, 390}}, kLeafDim);
  const Box all{{0, 0, 0}, leaves.count};
  for (const int size : {1, 2, 3, 8, 100}) {
    std::vector<std::vector<Box>> own(static_cast<std::size_t>(size));
    ThreadTeam(size).run(
        [&](Team& team) { own[static_cast<std::size_t>(team.rank())] = OwnLeaves(leaves, team).of(all); });
    std::vector<int> owners(static_cast<std::size_t>(leaves.size()));
    for (const std::vector<Box>& boxes : own) {
      for (const Box& box : boxes) {
        for_each_index(box, [&](const Index3& at) { ++owners[static_cast<std::size_t>(leaves.linear(at))]; });
      }
    }
    EXPECT_EQ(owners, std::vector<int>(owners.size(), 1)) << size;
  }
}

TEST(RegionShare, AloneOwnsAnyBoxInOnePiece) {
  const NodeLattice leaves = make_lattice({{3, 3, 3}, {700, 500, 300}}, kLeafDim);
  const OwnLeaves own(leaves, no_team());
  const Box box{{1, 2, 3}, {80, 50, 20}};
  EXPECT_EQ(own.of(box), (std::vector<Box>{box}));
}

}  // namespace
}  // namespace weir::region_share_test
