// Tests the search for elements that no box covers.
#include "ingest/hdf5/virtual/coverage.h"

#include <gtest/gtest.h>

#include <optional>

namespace weir::coverage_test {
namespace {

using Element = std::vector<hsize_t>;
constexpr auto kCovered = std::nullopt;

std::optional<Element> first_uncovered(const AxisBox& whole, const std::vector<AxisBox>& covers) {
  const Uncovered found = uncovered(whole, covers);
  EXPECT_EQ(found.count == 0, found.first.empty());
  if (found.count == 0) return std::nullopt;
  return found.first;
}

TEST(Coverage, WithoutBoxesTheFirstElementIsUncovered) {
  EXPECT_EQ(first_uncovered({{3, 4}, {5, 6}}, {}), (Element{3, 4}));
  EXPECT_EQ(uncovered({{3, 4}, {5, 6}}, {}).count, 4U);
}

TEST(Coverage, OneBoxCoversItselfAndWhatIsInside) {
  const std::vector<AxisBox> one{{{1, 1, 1}, {4, 5, 6}}};
  EXPECT_EQ(first_uncovered(one[0], one), kCovered);
  EXPECT_EQ(first_uncovered({{2, 2, 2}, {3, 3, 3}}, one), kCovered);
  EXPECT_EQ(first_uncovered({{1, 1, 1}, {4, 5, 7}}, one), (Element{1, 1, 6}));
  EXPECT_EQ(first_uncovered({{0, 1, 1}, {4, 5, 6}}, one), (Element{0, 1, 1}));
}

TEST(Coverage, TilesThatTouchOrOverlapCover) {
  std::vector<AxisBox> tiles{{{0, 0}, {2, 3}}, {{2, 0}, {4, 3}}, {{0, 3}, {4, 6}}};
  EXPECT_EQ(first_uncovered({{0, 0}, {4, 6}}, tiles), kCovered);
  tiles.push_back({{1, 1}, {3, 5}});
  EXPECT_EQ(first_uncovered({{0, 0}, {4, 6}}, tiles), kCovered);
}

TEST(Coverage, TheHoleOfAFrameIsFound) {
  const std::vector<AxisBox> frame{{{0, 0}, {1, 5}}, {{4, 0}, {5, 5}}, {{0, 0}, {5, 1}}, {{0, 4}, {5, 5}}};
  EXPECT_EQ(first_uncovered({{0, 0}, {5, 5}}, frame), (Element{1, 1}));
  EXPECT_EQ(uncovered({{0, 0}, {5, 5}}, frame).count, 9U);
  EXPECT_EQ(first_uncovered({{0, 0}, {5, 1}}, frame), kCovered);
}

TEST(Coverage, RandomBoxesAgreeWithCountedElements) {
  // Pseudo-random boxes in a lattice of 4^3 elements, the same in each run. The reference marks each covered element.
  unsigned state = 1;
  const auto next = [&](unsigned below) { return (state = state * 1103515245U + 12345U) / 65536U % below; };
  for (int round = 0; round < 200; ++round) {
    std::vector<AxisBox> boxes;
    bool held[4][4][4] = {};
    for (int b = 0; b < 12; ++b) {
      AxisBox box;
      for (int axis = 0; axis < 3; ++axis) {
        const unsigned lo = next(4);
        box.lo.push_back(lo);
        box.hi.push_back(lo + 1 + next(4 - lo));
      }
      for (hsize_t z = box.lo[0]; z < box.hi[0]; ++z) {
        for (hsize_t y = box.lo[1]; y < box.hi[1]; ++y) {
          for (hsize_t x = box.lo[2]; x < box.hi[2]; ++x) held[z][y][x] = true;
        }
      }
      boxes.push_back(std::move(box));
    }
    std::optional<Element> first;
    std::uint64_t count = 0;
    for (hsize_t i = 64; i-- > 0;) {
      if (held[i / 16][i / 4 % 4][i % 4]) continue;
      first = Element{i / 16, i / 4 % 4, i % 4};
      ++count;
    }
    EXPECT_EQ(uncovered({{0, 0, 0}, {4, 4, 4}}, boxes).count, count) << round;
    EXPECT_EQ(first_uncovered({{0, 0, 0}, {4, 4, 4}}, boxes), first) << round;
  }
}

TEST(Coverage, TwentyThousandPlanesAreCheckedQuickly) {
  std::vector<AxisBox> planes;
  for (hsize_t z = 0; z < 20000; ++z) planes.push_back({{z, 0, 0}, {z + 1, 2048, 2048}});
  EXPECT_EQ(first_uncovered({{0, 0, 0}, {20000, 2048, 2048}}, planes), kCovered);
  planes[12345].hi[1] = 2047;
  EXPECT_EQ(first_uncovered({{0, 0, 0}, {20000, 2048, 2048}}, planes), (Element{12345, 2047, 0}));
}

}  // namespace
}  // namespace weir::coverage_test
