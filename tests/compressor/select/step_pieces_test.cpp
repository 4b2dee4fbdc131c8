#include "compressor/select/step_pieces.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace weir {
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20U;

TEST(StepPieces, GiveNoMoreMemoryThanTheyMayTake) {
  StepPieces pieces(kMiB + StepPieces::kPieceBytes / 2);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(pieces.next().size(), StepPieces::kPieceBytes) << i;
  EXPECT_TRUE(pieces.next().empty());
  EXPECT_TRUE(pieces.next().empty());
  EXPECT_TRUE(StepPieces(StepPieces::kPieceBytes - 1).next().empty());
}

TEST(StepPieces, GiveEachThreadMemoryOfItsOwn) {
  constexpr std::size_t kCount = 200;  // more than one block of large pages
  StepPieces pieces(kCount * StepPieces::kPieceBytes);
  std::vector<std::span<std::byte>> given(kCount);
  tbb::parallel_for(std::size_t{0}, kCount, [&](std::size_t i) {
    given[i] = pieces.next();
    std::memset(given[i].data(), static_cast<int>(i), given[i].size());
  });
  for (std::size_t i = 0; i < kCount; ++i) {
    ASSERT_EQ(given[i].size(), StepPieces::kPieceBytes) << i;
    EXPECT_TRUE(std::all_of(given[i].begin(), given[i].end(), [&](std::byte b) { return b == std::byte(i); })) << i;
  }
  EXPECT_TRUE(pieces.next().empty());
}

}  // namespace
}  // namespace weir
