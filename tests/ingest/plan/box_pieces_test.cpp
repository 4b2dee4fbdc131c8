#include "ingest/plan/box_pieces.h"

#include <gtest/gtest.h>

#include <vector>

namespace weir::box_pieces_test {
namespace {

/// Follows the pieces through a file in which voxel i has the value i. Checks that every value of the box is read once,
/// from its place, and that no piece is larger than `piece_bytes`. Returns the pieces.
std::vector<BoxPiece> check(const Index3& extent, const Box& box, std::size_t voxel_bytes, std::uint64_t header,
                            std::uint64_t piece_bytes) {
  const BoxPieces pieces(extent, box, voxel_bytes, header, piece_bytes);
  std::vector<BoxPiece> list;
  std::vector<std::int64_t> found(static_cast<std::size_t>(box.voxels()), -1);
  for (std::int64_t i = 0; i < pieces.size(); ++i) {
    const BoxPiece piece = pieces.piece(i);
    EXPECT_LE(piece.bytes, piece_bytes);
    EXPECT_EQ(piece.bytes, static_cast<std::uint64_t>(piece.runs - 1) * piece.stride_bytes +
                               static_cast<std::uint64_t>(piece.run_voxels) * voxel_bytes);
    for (std::int64_t r = 0; r < piece.runs; ++r) {
      const std::uint64_t offset = piece.offset + static_cast<std::uint64_t>(r) * piece.stride_bytes - header;
      EXPECT_EQ(offset % voxel_bytes, 0U);
      for (std::int64_t v = 0; v < piece.run_voxels; ++v) {
        auto& value = found.at(static_cast<std::size_t>(piece.first_value + r * piece.run_voxels + v));
        EXPECT_EQ(value, -1);
        value = static_cast<std::int64_t>(offset / voxel_bytes) + v;
      }
    }
    list.push_back(piece);
  }
  std::size_t i = 0;
  for (std::int64_t z = box.lo.z; z < box.hi.z; ++z) {
    for (std::int64_t y = box.lo.y; y < box.hi.y; ++y) {
      for (std::int64_t x = box.lo.x; x < box.hi.x; ++x) {
        EXPECT_EQ(found[i++], linear_index({x, y, z}, extent));
      }
    }
  }
  return list;
}

TEST(BoxPieces, WholePlanesAreOneRun) {
  const auto one = check({7, 5, 9}, {{0, 0, 2}, {7, 5, 6}}, 4, 100, 1 << 20);
  ASSERT_EQ(one.size(), 1U);
  EXPECT_EQ(one[0].offset, 100U + 2 * 35 * 4);
  EXPECT_EQ(one[0].bytes, 4U * 35 * 4);
  EXPECT_EQ(check({7, 5, 9}, {{0, 0, 0}, {7, 5, 9}}, 4, 0, 128).size(), 10U);  // 315 voxels, 32 per piece
}

TEST(BoxPieces, WholeRowsAreARunAPlane) {
  // The box has 3 of 5 rows per plane. The gap of 2 rows is read too, and 2 planes fit into a piece.
  const auto grouped = check({7, 5, 9}, {{0, 1, 0}, {7, 4, 9}}, 4, 0, 250);
  ASSERT_EQ(grouped.size(), 5U);
  EXPECT_EQ(grouped[0].runs, 2);
  EXPECT_EQ(grouped[0].stride_bytes, 140U);
  EXPECT_EQ(grouped[4].runs, 1);
  // Runs of 84 bytes are cut at 80 bytes.
  EXPECT_EQ(check({7, 5, 9}, {{0, 1, 0}, {7, 4, 9}}, 4, 0, 80).size(), 18U);
}

TEST(BoxPieces, PartsOfRows) {
  check({7, 5, 9}, {{2, 1, 3}, {6, 4, 8}}, 4, 13, 1 << 20);
  check({7, 5, 9}, {{2, 1, 3}, {6, 4, 8}}, 4, 13, 44);
  check({7, 5, 9}, {{2, 1, 3}, {6, 4, 8}}, 4, 13, 16);
  check({7, 5, 9}, {{2, 1, 3}, {6, 4, 8}}, 8, 0, 9);
  check({7, 5, 9}, {{6, 4, 8}, {7, 5, 9}}, 1, 0, 1);
}

TEST(BoxPieces, WideGapsAreSkipped) {
  const std::int64_t width = static_cast<std::int64_t>(kMaxGapBytes) + 8;
  const auto through = check({width, 4, 1}, {{0, 0, 0}, {8, 4, 1}}, 1, 0, 1 << 20);
  ASSERT_EQ(through.size(), 1U);
  EXPECT_EQ(through[0].runs, 4);
  const auto skipped = check({width + 1, 4, 1}, {{0, 0, 0}, {8, 4, 1}}, 1, 0, 1 << 20);
  ASSERT_EQ(skipped.size(), 4U);
  EXPECT_EQ(skipped[0].bytes, 8U);
}

TEST(BoxPieces, OffsetsBeyond32Bits) {
  const Index3 extent{3000, 3000, 3000};
  const BoxPieces pieces(extent, {{0, 2944, 2944}, {3000, 3000, 3000}}, 4, 0, 1 << 20);
  EXPECT_EQ(pieces.size(), 56);  // 56 planes, 672,000 bytes each
  const BoxPiece last = pieces.piece(55);
  EXPECT_EQ(last.offset + last.bytes, 108'000'000'000U);
}

}  // namespace
}  // namespace weir::box_pieces_test
