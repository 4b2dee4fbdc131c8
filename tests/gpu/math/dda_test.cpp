#include "gpu/math/dda.h"

#include <gtest/gtest.h>

#include <cfloat>
#include <vector>

#include "gpu/math/random.h"

namespace weir::dda_test {
namespace {

constexpr CellLattice kLattice{{4, 3, 2}, {0, 0, 0}, 16};
constexpr RayBox kBox{{}, {64, 48, 32}};

std::vector<CellSpan> walk(const CellLattice& lattice, const Ray& ray, float t0, float t1) {
  std::vector<CellSpan> spans;
  CellWalk cells(lattice, ray, t0, t1);
  CellSpan span;
  while (cells.next(lattice, ray, span)) {
    spans.push_back(span);
    if (spans.size() > 1000) ADD_FAILURE() << "endless walk";
    if (spans.size() > 1000) break;
  }
  return spans;
}

std::vector<std::int64_t> cells_of_positive_length(const std::vector<CellSpan>& spans) {
  std::vector<std::int64_t> cells;
  for (const CellSpan& span : spans) {
    if (span.t1 > span.t0) cells.push_back(span.cell);
  }
  return cells;
}

// Checks that the spans join without a gap from t0 to t1.
void expect_covers(const std::vector<CellSpan>& spans, float t0, float t1) {
  ASSERT_FALSE(spans.empty());
  EXPECT_EQ(spans.front().t0, t0);
  EXPECT_EQ(spans.back().t1, t1);
  for (std::size_t i = 1; i < spans.size(); ++i) EXPECT_EQ(spans[i].t0, spans[i - 1].t1);
  for (const CellSpan& span : spans) EXPECT_LE(span.t0, span.t1);
}

TEST(CellWalk, AlongOneAxisWithZeroComponents) {
  const auto spans = walk(kLattice, {{0, 8, 8}, {1, 0, 0}}, 0, 64);
  expect_covers(spans, 0, 64);
  EXPECT_EQ(cells_of_positive_length(spans), (std::vector<std::int64_t>{0, 1, 2, 3}));
  EXPECT_EQ(spans[1].t0, 16.0F);
  EXPECT_EQ(spans[1].t1, 32.0F);
}

TEST(CellWalk, NegativeZeroIsZero) {
  const auto spans = walk(kLattice, {{8, 40, 31}, {-0.0F, -1, -0.0F}}, 0, 40);
  expect_covers(spans, 0, 40);
  EXPECT_EQ(cells_of_positive_length(spans), (std::vector<std::int64_t>{20, 16, 12}));
}

// A prototype computed 0 * inf here: the origin lies exactly on a border and the direction runs along it.
TEST(CellWalk, ARayAlongABorder_VisitsEachCellOnce) {
  const auto spans = walk(kLattice, {{0, 16, 16}, {1, 0, 0}}, 0, 64);
  expect_covers(spans, 0, 64);
  EXPECT_EQ(cells_of_positive_length(spans), (std::vector<std::int64_t>{16, 17, 18, 19}));
}

TEST(CellWalk, FromABorderBackwards) {
  const auto spans = walk(kLattice, {{32, 8, 8}, {-1, 0, 0}}, 0, 32);
  expect_covers(spans, 0, 32);
  EXPECT_EQ(cells_of_positive_length(spans), (std::vector<std::int64_t>{1, 0}));
}

TEST(CellWalk, FromTheUpperFaceBackwards) {
  const auto spans = walk(kLattice, {{64, 48, 32}, {-1, -1, -1}}, 0, 32);
  expect_covers(spans, 0, 32);
  EXPECT_EQ(spans.front().cell, 23);
}

TEST(CellWalk, ThroughCorners) {
  const auto spans = walk(kLattice, {{0, 0, 0}, {1, 1, 1}}, 0, 32);
  expect_covers(spans, 0, 32);
  EXPECT_EQ(cells_of_positive_length(spans), (std::vector<std::int64_t>{0, 17}));
}

TEST(CellWalk, ThroughEdgesOfCells) {
  const auto spans = walk(kLattice, {{0, 32, 8}, {1, -1, 0}}, 0, 32);
  expect_covers(spans, 0, 32);
  // The ray is in the cells above y = 32 for zero length.
  EXPECT_EQ(cells_of_positive_length(spans), (std::vector<std::int64_t>{4, 1}));
}

TEST(CellWalk, DenormalDirection) {
  const auto spans = walk(kLattice, {{0, 16, 8}, {1, FLT_TRUE_MIN, -FLT_TRUE_MIN}}, 0, 64);
  expect_covers(spans, 0, 64);
  EXPECT_EQ(cells_of_positive_length(spans).size(), 4U);
}

TEST(CellWalk, EmptyInterval) {
  EXPECT_TRUE(walk(kLattice, {{0, 8, 8}, {1, 0, 0}}, 5, 5).empty());
  EXPECT_TRUE(walk(kLattice, {{0, 8, 8}, {1, 0, 0}}, 6, 5).empty());
}

TEST(CellWalk, ZeroDirectionStaysInItsCell) {
  const auto spans = walk(kLattice, {{20, 20, 20}, {0, 0, 0}}, 0, 1);
  ASSERT_EQ(spans.size(), 1U);
  EXPECT_EQ(spans[0].cell, 1 + 4 * (1 + 3 * 1));
}

TEST(CellWalk, ShiftedLattice) {
  const CellLattice shifted{{2, 1, 1}, {10, 3, 0}, 16};
  const auto spans = walk(shifted, {{0, 5, 5}, {1, 0, 0}}, 0, 20);
  expect_covers(spans, 0, 20);
  ASSERT_EQ(cells_of_positive_length(spans), (std::vector<std::int64_t>{0, 1}));
  EXPECT_EQ(spans[0].t1, 6.0F);
}

TEST(CellWalk, OneVoxelThickNeedle) {
  const CellLattice needle{{1, 1, 6250}, {0, 0, 0}, 16};
  const Ray ray{{0.5F, 0.5F, 0}, {0, 0, 1}};
  CellWalk cells(needle, ray, 0, 1e5F);
  CellSpan span;
  std::int64_t steps = 0;
  while (cells.next(needle, ray, span)) EXPECT_EQ(span.cell, steps++);
  EXPECT_EQ(steps, 6250);
}

// For any ray: the walk is bounded and has no gap, and the middle of every span lies in the span's cell.
TEST(CellWalk, RandomRays) {
  for (std::uint64_t k = 0; k < 20000; ++k) {
    Random random(1, k, 0);
    const auto coordinate = [&](float extent) {
      const float u = random.uniform();
      return u < 0.3F ? 16.0F * std::floor(random.uniform() * (extent / 16 + 1)) : random.uniform() * extent;
    };
    const auto component = [&] { return random.uniform() < 0.2F ? 0.0F : 2 * random.uniform() - 1; };
    Ray ray{{coordinate(64), coordinate(48), coordinate(32)}, {component(), component(), component()}};
    float t0 = 0;
    float t1 = 1e4F;
    if (!clip(ray, kBox, t0, t1)) continue;
    const auto spans = walk(kLattice, ray, t0, t1);
    ASSERT_LE(spans.size(), 10U);
    EXPECT_EQ(spans.front().t0, t0);
    for (std::size_t i = 1; i < spans.size(); ++i) ASSERT_EQ(spans[i].t0, spans[i - 1].t1);
    for (const CellSpan& span : spans) {
      if (span.t1 - span.t0 < 1e-3F) continue;
      const Float3 p = ray.at(0.5F * (span.t0 + span.t1)) * (1.0F / 16);
      const auto inside = [](float at, std::int64_t cell) {
        return at >= static_cast<float>(cell) - 1e-4F && at <= static_cast<float>(cell) + 1.0001F;
      };
      ASSERT_TRUE(inside(p.x, span.cell % 4) && inside(p.y, span.cell / 4 % 3) && inside(p.z, span.cell / 12));
    }
    EXPECT_NEAR(spans.back().t1, t1, 1e-4F * t1);
  }
}

TEST(Clip, ZeroComponentOnTheFaces) {
  float t0 = 0;
  float t1 = kInfinity;
  EXPECT_TRUE(clip({{-1, 0, 5}, {1, 0, 0}}, kBox, t0, t1)) << "the lower face belongs to the box";
  EXPECT_EQ(t0, 1.0F);
  EXPECT_EQ(t1, 65.0F);
  t0 = 0;
  t1 = kInfinity;
  EXPECT_FALSE(clip({{-1, 48, 5}, {1, 0, 0}}, kBox, t0, t1)) << "the upper face does not";
}

TEST(Clip, FromAFaceOutwardsIsAMiss) {
  float t0 = 0;
  float t1 = kInfinity;
  EXPECT_FALSE(clip({{0, 8, 8}, {-1, 0, 0}}, kBox, t0, t1));
  t0 = 0;
  t1 = kInfinity;
  EXPECT_FALSE(clip({{64, 8, 8}, {1, 0.5F, 0}}, kBox, t0, t1));
}

TEST(Enter, MovesTheOriginToTheBox) {
  Ray ray{{-1000, 8, 8}, {2, 0, 0}};
  EXPECT_EQ(enter(ray, kBox), 32.0F);
  EXPECT_EQ(ray.origin, (Float3{0, 8, 8}));
  Ray inside{{10, 10, 10}, {0, 1, 0}};
  EXPECT_EQ(enter(inside, kBox), 38.0F);
  EXPECT_EQ(inside.origin, (Float3{10, 10, 10}));
  Ray still{{10, 10, 10}, {0, 0, 0}};
  EXPECT_EQ(enter(still, kBox), 0.0F);
}

}  // namespace
}  // namespace weir::dda_test
