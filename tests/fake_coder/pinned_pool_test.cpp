// Page-locked memory that is kept for the next conversion, on the pretended CUDA runtime.
#include "gpu/cuda/encode/pinned_pool.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "tests/fake_coder/support.h"
#include "tests/fake_cuda/fake_runtime.h"

namespace weir::fake_coder_test {
namespace {

using test::FakeRuntime;

constexpr std::size_t kMiB = std::size_t{1} << 20U;

class PinnedPoolTest : public testing::Test {
 protected:
  PinnedPoolTest() { reset_device(); }
  ~PinnedPoolTest() override {
    pool_.clear();
    EXPECT_EQ(FakeRuntime::instance().allocated_bytes(), 0U);
  }

  PinnedPool::Piece take(std::size_t bytes) {
    std::string refusal;
    std::optional<PinnedPool::Piece> piece = pool_.take(bytes, refusal);
    if (!piece) throw std::runtime_error(refusal);
    return std::move(*piece);
  }
  static std::uint64_t locked() { return FakeRuntime::instance().calls("cudaHostAlloc"); }

  PinnedPool pool_;
};

TEST_F(PinnedPoolTest, GivesTheSmallestPieceThatDoes) {
  PinnedPool::Piece large = take(3 * kMiB);
  PinnedPool::Piece small = take(2 * kMiB);
  const std::byte* const at = small.memory.data();
  pool_.give_back(std::move(large));
  pool_.give_back(std::move(small));
  EXPECT_EQ(pool_.held_bytes(), 5 * kMiB);
  EXPECT_EQ(take(kMiB).memory.data(), at);
  EXPECT_EQ(locked(), 2U);
  EXPECT_EQ(pool_.held_bytes(), 3 * kMiB);
  EXPECT_EQ(take(4 * kMiB).bytes, 4 * kMiB);
  EXPECT_EQ(locked(), 3U);
}

TEST_F(PinnedPoolTest, HoldsNoMoreThanItMay) {
  PinnedPool::Piece first = take(PinnedPool::kMostHeld);
  PinnedPool::Piece second = take(kMiB);
  pool_.give_back(std::move(first));
  pool_.give_back(std::move(second));
  EXPECT_EQ(pool_.held_bytes(), PinnedPool::kMostHeld);
  EXPECT_EQ(FakeRuntime::instance().allocated_bytes(), PinnedPool::kMostHeld) << "the second is freed";
}

TEST_F(PinnedPoolTest, DoesNotGiveWhatADeviceThatWasResetHasNoMore) {
  pool_.give_back(take(kMiB));
  FakeRuntime::instance().reset();
  const PinnedPool::Piece piece = take(kMiB);
  EXPECT_EQ(locked(), 1U);
  EXPECT_EQ(pool_.held_bytes(), 0U);
}

}  // namespace
}  // namespace weir::fake_coder_test
