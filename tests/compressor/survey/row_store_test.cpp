#include "compressor/survey/row_store.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <mutex>
#include <vector>

#include "compressor/select/region_rows.h"
#include "tests/compressor/support/crash_file_system.h"

namespace weir::row_store_test {
namespace {

// Returns rows with their linear index in `sse`.
RowStore numbered_rows(const Box& domain, std::int64_t segment_regions) {
  RowStore store(test::CrashFileSystem().create_unnamed("rows"), make_lattice(domain, kLeafDim), {segment_regions, 0});
  std::vector<LeafRow> rows(static_cast<std::size_t>(store.leaves().size()));
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i].sse = static_cast<double>(i);
  // Writes them in two parts.
  const std::size_t half = rows.size() / 2;
  store.write(static_cast<std::int64_t>(half), std::span(rows).subspan(half));
  store.write(0, std::span(rows).first(half));
  return store;
}

const Box kDomain{{-140, -9, 100}, {150, 140, 135}};

TEST(RowStore, ReadsBackRunsAndBoxes) {
  const RowStore store = numbered_rows(kDomain, 1);
  const NodeLattice& leaves = store.leaves();
  std::vector<LeafRow> run(7);
  store.read(40, run);
  for (std::size_t i = 0; i < run.size(); ++i) EXPECT_EQ(run[i].sse, 40 + static_cast<double>(i));
  const Index3 n = leaves.count;
  for (const Box& box : {Box{{0, 0, 0}, n}, Box{{0, 1, 1}, {n.x, 3, 4}}, Box{{0, 0, 2}, {n.x, n.y, 3}},
                         Box{{2, 3, 1}, {5, 4, 3}}, Box{{n.x - 1, n.y - 1, n.z - 1}, n}}) {
    std::vector<LeafRow> rows;
    store.read_box(box, rows);
    ASSERT_EQ(std::ssize(rows), box.voxels());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const Index3 leaf = box.lo + index_at(static_cast<std::int64_t>(i), box.extent());
      ASSERT_EQ(rows[i].sse, static_cast<double>(leaves.linear(leaf)));
    }
  }
}

TEST(RegionRows, VisitsEveryRegionOnceWithItsRowsInLeafOrder) {
  const TreeRegions tree(kDomain);
  for (const std::int64_t segment : {1, 2, 64}) {
    const RowStore store = numbered_rows(kDomain, segment);
    std::mutex mutex;
    std::vector<int> visits(tree.regions.size());
    std::vector<int> seen(static_cast<std::size_t>(store.leaves().size()));
    for_each_own_region(tree, store, [&](std::int64_t region, const RegionRows& rows) {
      const std::scoped_lock lock(mutex);
      ++visits[static_cast<std::size_t>(region)];
      EXPECT_EQ(rows.leaf_box(), tree.leaf_box(region));
      double last = -1;
      rows.for_each([&](const Index3& leaf, const LeafRow& row) {
        EXPECT_EQ(row.sse, static_cast<double>(store.leaves().linear(leaf)));
        EXPECT_GT(row.sse, last);
        EXPECT_EQ(&rows.at(leaf), &row);
        last = row.sse;
        ++seen[static_cast<std::size_t>(row.sse)];
      });
    });
    EXPECT_EQ(visits, std::vector<int>(visits.size(), 1));
    EXPECT_EQ(seen, std::vector<int>(seen.size(), 1));
  }
}

TEST(RegionRows, VisitsABoxOfRegionsOnly) {
  const TreeRegions tree(kDomain);
  const RowStore store = numbered_rows(kDomain, 2);
  const Box box{{1, 0, 0}, {tree.region_lattice.count.x, 1, 2}};
  std::mutex mutex;
  std::vector<std::int64_t> visited;
  for_each_region(tree, store, box, [&](std::int64_t region, const RegionRows&) {
    const std::scoped_lock lock(mutex);
    visited.push_back(region);
  });
  std::sort(visited.begin(), visited.end());
  std::vector<std::int64_t> expected;
  for (std::int64_t n = 0; n < box.voxels(); ++n) {
    expected.push_back(tree.region_lattice.linear(box.lo + index_at(n, box.extent())));
  }
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(visited, expected);
}

}  // namespace
}  // namespace weir::row_store_test
