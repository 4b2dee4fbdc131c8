// Tests the tree over a level's boxes: which boxes it finds, and how many nodes it visits for boxes of any shape.
#include "ingest/amrex/box_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <random>
#include <vector>

#include "tests/support/message_of_error.h"

namespace weir::box_index_test {
namespace {

using Boxes = std::vector<CellBox>;

Boxes shuffled(Boxes boxes) {
  std::shuffle(boxes.begin(), boxes.end(), std::mt19937_64(7));
  return boxes;
}

/// Returns `count.x * count.y * count.z` boxes of `size` cells, side by side, in random order.
Boxes grid_of(const Index3& count, const Index3& size) {
  const auto small = [](std::int64_t i) { return static_cast<std::int32_t>(i); };
  Boxes boxes;
  for_each_index({{0, 0, 0}, count}, [&](const Index3& i) {
    const Index3 lo{i.x * size.x, i.y * size.y, i.z * size.z};
    const Index3 last = lo + size - Index3{1, 1, 1};
    boxes.push_back({{small(lo.x), small(lo.y), small(lo.z)}, {small(last.x), small(last.y), small(last.z)}});
  });
  return shuffled(boxes);
}

/// Returns `count` x `count` pencils of 401 cells along x with random beginnings.
Boxes staggered_pencils(std::int32_t count) {
  std::mt19937_64 random(3);
  Boxes boxes;
  for (std::int32_t z = 0; z < count; ++z) {
    for (std::int32_t y = 0; y < count; ++y) {
      const auto lo = static_cast<std::int32_t>(random() % 300);
      boxes.push_back({{lo, y, z}, {lo + 400, y, z}});
    }
  }
  return shuffled(boxes);
}

/// Finds each of the boxes in their index. Returns the sum of the tree nodes that this visits.
std::size_t nodes_looked_at(const Boxes& boxes) {
  const BoxIndex index(boxes);
  std::size_t nodes = 0;
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    found.clear();
    nodes += index.find(boxes[i].box(), found);
    EXPECT_EQ(found, std::vector<std::uint32_t>{i});
  }
  return nodes;
}

TEST(BoxIndex, BoxesOfAnyShape_AreFoundInFewNodes) {
  // A path from the root of a tree over 20,000 boxes to a leaf has 13 nodes. The siblings of its nodes are visited too.
  constexpr std::size_t kMostNodes = 60;
  for (const Boxes& boxes :
       {grid_of({1, 141, 141}, {256, 1, 1}), grid_of({141, 1, 141}, {1, 256, 1}), grid_of({141, 141, 1}, {1, 1, 256}),
        grid_of({1, 1, 20'000}, {40'000, 40'000, 1}), grid_of({27, 27, 27}, {8, 8, 8}), staggered_pencils(141)}) {
    EXPECT_LT(nodes_looked_at(boxes) / boxes.size(), kMostNodes);
  }
}

TEST(BoxIndex, BoxesThatHaveCellsInCommon_AreFoundAmongPencils) {
  Boxes boxes = grid_of({1, 141, 141}, {256, 1, 1});
  EXPECT_EQ(BoxIndex(boxes).overlapping(), (std::pair<std::uint32_t, std::uint32_t>{0, 0}));
  const CellBox first = boxes[100];
  boxes.push_back({{255, first.lo[1], first.lo[2]}, {300, first.last[1], first.last[2]}});
  const auto last = static_cast<std::uint32_t>(boxes.size() - 1);
  EXPECT_EQ(BoxIndex(boxes).overlapping(), (std::pair<std::uint32_t, std::uint32_t>{100, last}));
}

TEST(BoxIndex, Interruption_EndsTheSearchForOverlaps) {
  const Boxes boxes = grid_of({4, 4, 4}, {8, 8, 8});
  const std::atomic<bool> interrupted{true};
  EXPECT_EQ(message_of_error(ErrorKind::interrupted, [&] { BoxIndex(boxes).overlapping(&interrupted); }),
            "interrupted");
}

}  // namespace
}  // namespace weir::box_index_test
