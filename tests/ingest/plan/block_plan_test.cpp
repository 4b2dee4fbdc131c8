#include "ingest/plan/block_plan.h"

#include <vector>

#include "tests/ingest/support/scratch.h"

namespace weir::block_plan_test {
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20U;

Box at_origin(const Index3& extent) { return {{0, 0, 0}, extent}; }

/// Returns the plan of plan_blocks() after checks: blocks fit the budget and lie in the domain. Of fewer than 10,000
/// blocks it also checks that the largest takes block_bytes, and that all together have the domain's voxels, in order.
BlockPlan checked_plan(const Box& domain, const AccessShape& access, std::uint64_t budget) {
  const BlockPlan plan = plan_blocks(domain, access, budget);
  EXPECT_LE(plan.block_bytes, budget);
  std::int64_t voxels = 0;
  std::uint64_t largest = 0;
  Box leaves_before{};
  // Of a huge plan, only 5000 to 10,000 blocks and both ends are looked at.
  const std::int64_t step = std::max<std::int64_t>(1, plan.size() / 5000);
  for (std::int64_t i = 0; i < plan.size(); i += step) {
    const Box leaves = plan.leaf_box(i);
    const Box box = plan.voxel_box(leaves);
    EXPECT_FALSE(leaves.empty()) << i;
    EXPECT_FALSE(box.empty()) << i;
    EXPECT_TRUE(domain.contains(box)) << i;
    largest = std::max(largest, static_cast<std::uint64_t>(box.voxels()) * 4);
    voxels += box.voxels();
    if (i > 0 && step == 1) {
      // The block begins where the block before it ended along x, or it begins a new row.
      EXPECT_TRUE(leaves.lo.x == leaves_before.hi.x || leaves.lo.x == 0) << i;
      EXPECT_TRUE(leaves.lo.x == 0 || leaves.lo.y == leaves_before.lo.y) << i;
    }
    leaves_before = leaves;
  }
  if (step == 1) {
    EXPECT_EQ(voxels, domain.voxels());
    EXPECT_EQ(largest, plan.block_bytes);
  }
  EXPECT_EQ(plan.leaf_box(0).lo, (Index3{0, 0, 0}));
  EXPECT_EQ(plan.leaf_box(plan.size() - 1).hi, plan.lattice.count);
  return plan;
}

/// Checks that every leaf of the lattice is in exactly one block.
void expect_each_leaf_once(const BlockPlan& plan) {
  std::vector<int> seen(static_cast<std::size_t>(plan.lattice.size()));
  for (std::int64_t i = 0; i < plan.size(); ++i) {
    const Box leaves = plan.leaf_box(i);
    for (std::int64_t z = leaves.lo.z; z < leaves.hi.z; ++z) {
      for (std::int64_t y = leaves.lo.y; y < leaves.hi.y; ++y) {
        for (std::int64_t x = leaves.lo.x; x < leaves.hi.x; ++x) {
          ++seen[static_cast<std::size_t>(plan.lattice.linear({x, y, z}))];
        }
      }
    }
  }
  for (const int times : seen) ASSERT_EQ(times, 1);
}

TEST(BlockPlan, OneVoxel) {
  const BlockPlan plan = checked_plan(at_origin({1, 1, 1}), {}, 4);
  EXPECT_EQ(plan.size(), 1);
  EXPECT_EQ(plan.block_bytes, 4U);
  EXPECT_EQ(plan.run_voxels, 1);
  EXPECT_EQ(plan.voxel_box(plan.leaf_box(0)), at_origin({1, 1, 1}));
}

TEST(BlockPlan, SmallVolumesAreOneBlock) {
  const BlockPlan plan = checked_plan(at_origin({128, 128, 128}), {}, 512 * kMiB);
  EXPECT_EQ(plan.size(), 1);
  EXPECT_EQ(plan.block_bytes, 8 * kMiB);
  EXPECT_EQ(plan.run_voxels, 1 << 21);
}

TEST(BlockPlan, CloudWidthAt256MiB) {
  // The paper's WDAS cloud. Half of 256 MiB holds two buffers, so a block has 64 MiB; a row of nodes takes 124 MiB.
  const Box domain = at_origin({1987, 1351, 2449});
  const BlockPlan tight = checked_plan(domain, {}, 64 * kMiB);
  EXPECT_EQ(tight.leaves, (Index3{249, 16, 8}));
  EXPECT_EQ(tight.run_voxels, 1987 * 128);
  const BlockPlan roomy = checked_plan(domain, {}, 128 * kMiB);
  EXPECT_EQ(roomy.leaves, (Index3{249, 16, 16}));
  EXPECT_EQ(roomy.block_bytes, 1987U * 128 * 128 * 4);
  EXPECT_EQ(roomy.count, (Index3{1, 11, 20}));
}

TEST(BlockPlan, Cube3000) {
  const Box domain = at_origin({3000, 3000, 3000});
  EXPECT_EQ(checked_plan(domain, {}, 188 * kMiB).leaves, (Index3{375, 16, 16}));
  EXPECT_EQ(checked_plan(domain, {}, 187 * kMiB).leaves, (Index3{375, 16, 8}));
  EXPECT_EQ(checked_plan(domain, {}, 12 * kMiB).leaves, (Index3{375, 16, 1}));
  EXPECT_EQ(checked_plan(domain, {}, 11 * kMiB).leaves, (Index3{375, 8, 1}));
  EXPECT_EQ(checked_plan(domain, {}, 768'000).leaves, (Index3{375, 1, 1}));
  EXPECT_EQ(checked_plan(domain, {}, 767'999).leaves, (Index3{368, 1, 1}));
}

TEST(BlockPlan, GrowsBeyondNodesToAmpleBlocksOnly) {
  const auto leaves = [](const Index3& extent, std::uint64_t budget) {
    return checked_plan(at_origin(extent), {}, budget).leaves;
  };
  EXPECT_EQ(leaves({1024, 1024, 1024}, 1024 * kMiB), (Index3{128, 16, 16}));  // a row of nodes: 64 MiB
  EXPECT_EQ(leaves({512, 512, 512}, 1024 * kMiB), (Index3{64, 16, 16}));      // 32 MiB
  EXPECT_EQ(leaves({256, 512, 512}, 1024 * kMiB), (Index3{32, 32, 16}));      // 2 rows
  EXPECT_EQ(leaves({256, 256, 1024}, 1024 * kMiB), (Index3{32, 32, 16}));     // all rows
  EXPECT_EQ(leaves({128, 128, 1024}, 1024 * kMiB), (Index3{16, 16, 64}));     // 4 layers of nodes
  EXPECT_EQ(leaves({128, 128, 1024}, 20 * kMiB), (Index3{16, 16, 32}));
}

TEST(BlockPlan, LinesAlongEachAxis) {
  constexpr std::int64_t kBillion = 1'000'000'000;
  const BlockPlan along_z = checked_plan(at_origin({1, 1, kBillion}), {}, 128 * kMiB);
  EXPECT_EQ(along_z.leaves, (Index3{1, 1, 131072 * 8}));
  EXPECT_EQ(along_z.block_bytes, 32 * kMiB);
  EXPECT_EQ(along_z.run_voxels, 8 * 1024 * 1024);
  const BlockPlan along_x = checked_plan(at_origin({kBillion, 1, 1}), {}, 128 * kMiB);
  EXPECT_EQ(along_x.leaves, (Index3{32 * 131072, 1, 1}));
  EXPECT_EQ(along_x.run_voxels, 32 * 1024 * 1024);
  const BlockPlan along_y = checked_plan(at_origin({1, kBillion, 1}), {}, 128 * kMiB);
  EXPECT_EQ(along_y.leaves.y, 131072 * 8);
  EXPECT_EQ(checked_plan(at_origin({1, 1, kBillion}), {}, 32).leaves, (Index3{1, 1, 1}));
}

TEST(BlockPlan, TinyBudgets) {
  const Box domain = at_origin({100, 50, 40});
  EXPECT_EQ(checked_plan(domain, {}, 2048).leaves, (Index3{1, 1, 1}));
  EXPECT_EQ(checked_plan(domain, {}, 4096).leaves, (Index3{2, 1, 1}));
  EXPECT_EQ(checked_plan(domain, {}, 25'599).leaves, (Index3{8, 1, 1}));
  EXPECT_EQ(checked_plan(domain, {}, 25'600).leaves, (Index3{13, 1, 1}));
  for (std::uint64_t budget = 2048; budget < 900'000; budget = budget * 5 / 4) {
    expect_each_leaf_once(checked_plan(domain, {}, budget));
    expect_each_leaf_once(checked_plan({{-66, -21, -90}, {60, 65, 64}}, {}, budget));
  }
}

TEST(BlockPlan, RefusesABudgetBelowOneLeaf) {
  EXPECT_EQ(message_of_error(ErrorKind::usage,
                             [] {
                               plan_blocks(at_origin({100, 50, 40}), {}, 2047);
                             }),
            "--memory leaves 2047 bytes for a block of the volume, and one leaf needs 2048; raise it");
  EXPECT_EQ(message_of_error(ErrorKind::usage,
                             [] {
                               plan_blocks(at_origin({3, 1, 1}), {}, 0);
                             }),
            "--memory leaves 0 bytes for a block of the volume, and one leaf needs 12; raise it");
}

TEST(BlockPlan, BlocksLieOnGlobalNodeEdges) {
  // OpenVDB input has such index ranges: they begin neither at zero nor at a multiple of a leaf or node.
  const Box domain{{-300, -21, -390}, {700, 565, 1154}};
  const BlockPlan plan = checked_plan(domain, {}, 64 * kMiB);
  expect_each_leaf_once(plan);
  EXPECT_EQ(plan.leaves, (Index3{126, 16, 16}));
  EXPECT_EQ(plan.count, (Index3{1, 6, 14}));
  for (std::int64_t i = 0; i < plan.size(); ++i) {
    const Box box = plan.voxel_box(plan.leaf_box(i));
    EXPECT_TRUE(box.lo.y == domain.lo.y || box.lo.y % 128 == 0) << i;
    EXPECT_TRUE(box.hi.y == domain.hi.y || box.hi.y % 128 == 0) << i;
    EXPECT_TRUE(box.lo.z == domain.lo.z || box.lo.z % 128 == 0) << i;
    EXPECT_TRUE(box.hi.z == domain.hi.z || box.hi.z % 128 == 0) << i;
  }
  EXPECT_EQ(plan.voxel_box(plan.leaf_box(0)), (Box{{-300, -21, -390}, {700, 0, -384}}));
  // Blocks that are parts of nodes never straddle two nodes either.
  const BlockPlan parts = checked_plan(domain, {}, 20 * kMiB);
  expect_each_leaf_once(parts);
  for (std::int64_t i = 0; i < parts.size(); ++i) {
    const Box box = parts.voxel_box(parts.leaf_box(i));
    EXPECT_EQ(floor_div(box.lo.y, 128), floor_div(box.hi.y - 1, 128)) << i;
    EXPECT_EQ(floor_div(box.lo.z, 128), floor_div(box.hi.z - 1, 128)) << i;
  }
}

TEST(BlockPlan, WholeChunks) {
  // The chunks of the openPMD example: rows of nodes hold whole chunks.
  const BlockPlan fine = checked_plan(at_origin({512, 512, 512}), {4, {32, 16, 16}, {}}, 64 * kMiB);
  EXPECT_EQ(fine.leaves, (Index3{64, 16, 16}));
  EXPECT_EQ(fine.amplification, 1.0);
  // Chunks of 100^3 voxels: blocks of 200 voxels end at chunk edges, nodes of 128 voxels would not.
  const BlockPlan hundred = checked_plan(at_origin({1000, 1000, 1000}), {4, {100, 100, 100}, {}}, 256 * kMiB);
  EXPECT_EQ(hundred.leaves, (Index3{125, 25, 25}));
  EXPECT_EQ(hundred.amplification, 1.0);
  // One plane per chunk, the usual NetCDF layout.
  const BlockPlan planes = checked_plan(at_origin({1000, 1000, 1000}), {4, {1000, 1000, 1}, {}}, 64 * kMiB);
  EXPECT_EQ(planes.leaves, (Index3{125, 125, 2}));
  EXPECT_EQ(planes.amplification, 1.0);
}

TEST(BlockPlan, CutsRowsAtChunkEdgesToKeepChunksWhole) {
  // A row of chunks does not fit the budget, but part of a row does: x is cut at chunk edges.
  const BlockPlan plan = checked_plan(at_origin({4096, 4096, 4096}), {4, {128, 256, 256}, {}}, 64 * kMiB);
  EXPECT_EQ(plan.leaves, (Index3{32, 32, 32}));
  EXPECT_EQ(plan.amplification, 1.0);
}

TEST(BlockPlan, AmplificationOfChunksThatDoNotFit) {
  // A chunk of 64^3 voxels takes 1 MiB; the budget holds a sixteenth. Rows of leaves would decode each chunk 8 x 8
  // times.
  const BlockPlan plan = checked_plan(at_origin({256, 256, 256}), {4, {64, 64, 64}, {}}, 65536);
  EXPECT_EQ(plan.leaves, (Index3{8, 4, 1}));
  EXPECT_EQ(plan.amplification, 16.0);
}

TEST(BlockPlan, PlaneChunksBeyondTheBudgetAreCutIntoStrips) {
  // Eight planes of 4096^2 voxels take 512 MiB. They are cut into as few strips as the budget allows.
  const Box domain = at_origin({4096, 4096, 1000});
  const AccessShape planes{4, {4096, 4096, 1}, {}};
  const BlockPlan plan = checked_plan(domain, planes, 150 * kMiB);
  EXPECT_EQ(plan.leaves, (Index3{512, 128, 1}));
  EXPECT_EQ(plan.amplification, 4.0);
  EXPECT_EQ(checked_plan(domain, planes, 100 * kMiB).amplification, 6.0);
  EXPECT_EQ(checked_plan(domain, planes, 512 * kMiB).amplification, 1.0);
}

TEST(BlockPlan, ChunksOffLeafEdgesAreReadMoreThanOnce) {
  // Chunk edges (75) and leaf edges (8) coincide only every 600 voxels; a block of 600^3 voxels takes 824 MiB.
  const Box domain = at_origin({1200, 1200, 1200});
  const AccessShape chunks{4, {75, 75, 75}, {}};
  EXPECT_EQ(checked_plan(domain, chunks, 824 * kMiB).amplification, 1.0);
  const BlockPlan plan = checked_plan(domain, chunks, 150 * kMiB);
  EXPECT_EQ(plan.leaves, (Index3{75, 38, 25}));
  EXPECT_DOUBLE_EQ(plan.amplification, 19.0 / 16 * 20 / 16);
}

TEST(BlockPlan, GivesTheBytesThatDecodeEveryChunkOnce) {
  const Box domain = at_origin({4096, 4096, 1000});
  const AccessShape planes{4, {4096, 4096, 1}, {}};
  const std::uint64_t enough = bytes_for_whole_chunks(domain, planes);
  EXPECT_EQ(enough, 512 * kMiB);
  // If chunk edges are off the leaf lattice, only blocks of the whole axis decode every chunk once.
  const Box odd = at_origin({64, 64, 512});
  const AccessShape off{4, {64, 64, 64}, {0, 0, 4}};
  EXPECT_EQ(bytes_for_whole_chunks(odd, off), 8 * kMiB);
  EXPECT_EQ(bytes_for_whole_chunks(odd, {}), kMiB);
}

TEST(BlockPlan, ChunksFromAnOddOrigin) {
  // A region of interest: chunks begin at 0 and the domain at 40. Blocks still end at chunk edges.
  const BlockPlan plan = checked_plan({{40, 40, 40}, {500, 500, 500}}, {4, {64, 80, 80}, {0, 0, 0}}, 32 * kMiB);
  expect_each_leaf_once(plan);
  EXPECT_EQ(plan.amplification, 1.0);
  for (std::int64_t i = 0; i < plan.size(); ++i) {
    const Box box = plan.voxel_box(plan.leaf_box(i));
    EXPECT_TRUE(box.lo.z == 40 || box.lo.z % 80 == 0) << i;
  }
  // Blocks cannot end at chunk edges that are off the leaf lattice. Each chunk that is cut is decoded twice.
  const BlockPlan off = checked_plan(at_origin({64, 64, 512}), {4, {64, 64, 64}, {0, 0, 4}}, 2 * kMiB);
  EXPECT_EQ(off.leaves, (Index3{8, 8, 16}));
  EXPECT_DOUBLE_EQ(off.amplification, 12.0 / 9.0);
}

TEST(BlockPlan, RandomDomainsAndBudgets) {
  std::uint64_t state = 1;
  const auto next = [&](std::int64_t lo, std::int64_t hi) {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    return lo + static_cast<std::int64_t>((state >> 33U) % static_cast<std::uint64_t>(hi - lo + 1));
  };
  for (int i = 0; i < 300; ++i) {
    const Index3 lo{next(-400, 400), next(-400, 400), next(-400, 400)};
    const Index3 extent{next(1, 300), next(1, 300), next(1, 300)};
    AccessShape access;
    if (i % 2 == 1) {
      access.chunk = {next(1, 100), next(1, 100), next(1, 100)};
      access.chunk_origin = lo + Index3{next(-9, 0), 0, next(-8, 0) * 8};
    }
    SCOPED_TRACE(i);
    const BlockPlan plan = checked_plan({lo, lo + extent}, access, static_cast<std::uint64_t>(next(2048, 9'000'000)));
    expect_each_leaf_once(plan);
    EXPECT_GE(plan.amplification, 1.0);
    EXPECT_GE(plan.run_voxels, 1);
  }
}

}  // namespace
}  // namespace weir::block_plan_test
