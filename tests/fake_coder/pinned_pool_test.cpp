// Page-locked memory that is kept for the next conversion, on the pretended CUDA runtime.
#include "gpu/cuda/encode/pinned_pool.h"

#include <cuda_runtime_api.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "tests/fake_cuda/fake_runtime.h"

namespace weir::fake_coder_test {
namespace {

using test::FakeRuntime;

constexpr std::size_t kMiB = std::size_t{1} << 20U;

class PinnedPoolTest : public testing::Test {
 protected:
  PinnedPoolTest() { runtime().reset(); }
  ~PinnedPoolTest() override {
    pool_.clear();
    EXPECT_EQ(runtime().allocated_bytes(), 0U);
  }

  static FakeRuntime& runtime() { return FakeRuntime::instance(); }
  PinnedPool::Piece take(std::size_t bytes) {
    std::string refusal;
    std::optional<PinnedPool::Piece> piece = pool_.take(bytes, refusal);
    if (!piece) throw std::runtime_error(refusal);
    return std::move(*piece);
  }
  static std::uint64_t locked() { return runtime().calls("cudaHostAlloc"); }

  PinnedPool pool_;
};

TEST_F(PinnedPoolTest, SeveralPiecesAreLargeEnough_TheSmallestIsGiven) {
  PinnedPool::Piece large = take(3 * kMiB);
  PinnedPool::Piece small = take(2 * kMiB);
  const std::byte* const at = small.memory.data();
  pool_.give_back(std::move(large));
  pool_.give_back(std::move(small));
  EXPECT_EQ(pool_.held_bytes(), 5 * kMiB);
  EXPECT_EQ(take(kMiB).memory.data(), at);
  EXPECT_EQ(locked(), 2U);
  EXPECT_EQ(pool_.held_bytes(), 3 * kMiB);
}

TEST_F(PinnedPoolTest, APieceMoreThanFourTimesAsLargeIsLeftToOthers) {
  PinnedPool::Piece nine = take(9 * kMiB);
  PinnedPool::Piece eight = take(8 * kMiB);
  pool_.give_back(std::move(nine));
  pool_.give_back(std::move(eight));
  EXPECT_EQ(take(2 * kMiB).bytes, 8 * kMiB);
  EXPECT_EQ(pool_.held_bytes(), 9 * kMiB);
  EXPECT_EQ(take(2 * kMiB).bytes, 2 * kMiB);
  EXPECT_EQ(pool_.held_bytes(), 0U) << "a new one takes the place of one that is held";
}

TEST_F(PinnedPoolTest, WhatCameBackFirstMakesRoomForWhatComesBackLater) {
  pool_.give_back(take(kMiB));
  PinnedPool::Piece large = take(PinnedPool::kMostHeld - kMiB);
  PinnedPool::Piece later = take(2 * kMiB);
  pool_.give_back(std::move(large));
  pool_.give_back(std::move(later));
  EXPECT_EQ(pool_.held_bytes(), 2 * kMiB);
  EXPECT_EQ(runtime().allocated_bytes(), 2 * kMiB);
  pool_.give_back(take(PinnedPool::kMostHeld + kMiB));
  EXPECT_EQ(runtime().allocated_bytes(), 0U) << "too large to be held";
}

// A program may work in its own context, which stays current in all of its steps.
TEST_F(PinnedPoolTest, WhatIsTooMuchToHoldIsFreedInItsOwnContext) {
  runtime().choose(0);
  runtime().make_current(FakeRuntime::own_context(0));
  pool_.give_back(take(PinnedPool::kMostHeld + kMiB));
  EXPECT_EQ(runtime().allocated_bytes(), 0U);
  EXPECT_EQ(runtime().current_context(), FakeRuntime::own_context(0));
}

// A program may reset its device, and then lock memory of its own at the same address.
TEST_F(PinnedPoolTest, WhatADeviceThatWasResetHasNoMore_IsNeitherGivenNorFreed) {
  pool_.give_back(take(kMiB));
  runtime().reset();
  void* others = nullptr;
  ASSERT_EQ(cudaHostAlloc(&others, kMiB, 0), cudaSuccess);
  {
    const PinnedPool::Piece piece = take(kMiB);
    EXPECT_NE(piece.memory.data(), others);
    EXPECT_EQ(locked(), 2U);
  }
  pool_.clear();
  EXPECT_EQ(runtime().allocated_bytes(), kMiB) << "the program's";
  cudaFreeHost(others);
}

}  // namespace
}  // namespace weir::fake_coder_test
