#include "format/io/bandwidth.h"

#include <gtest/gtest.h>

namespace weir::token_bucket_test {
namespace {

using namespace std::chrono_literals;

const TokenBucket::Time kStart = TokenBucket::Time() + 1000h;

TEST(TokenBucket, FullBucketIsFreeAndTheRestWaitsAtTheRate) {
  TokenBucket bucket(100, 50, kStart);
  EXPECT_EQ(bucket.take(50, kStart), kStart);
  EXPECT_EQ(bucket.take(0, kStart), kStart);
  EXPECT_EQ(bucket.take(100, kStart), kStart + 1s);
  EXPECT_EQ(bucket.take(100, kStart), kStart + 2s);  // debts add up, whoever made them
  EXPECT_EQ(bucket.take(10, kStart + 1s), kStart + 2100ms);
}

TEST(TokenBucket, IdleTimeRefillsUpToTheCapacity) {
  TokenBucket bucket(100, 50, kStart);
  bucket.take(50, kStart);
  EXPECT_EQ(bucket.take(25, kStart + 250ms), kStart + 250ms);
  EXPECT_EQ(bucket.take(51, kStart + 10h), kStart + 10h + 10ms);
}

TEST(TokenBucket, LongRunRateIsIndependentOfThePieceSize) {
  for (const std::uint64_t piece : {1U, 7U, 1000U, 123456U}) {
    TokenBucket bucket(1000, 100, kStart);
    TokenBucket::Time now = kStart;
    std::uint64_t moved = 0;
    for (; moved < 1'000'000; moved += piece) now = bucket.take(piece, now);
    const double seconds = std::chrono::duration<double>(now - kStart).count();
    EXPECT_NEAR(seconds, (static_cast<double>(moved) - 100) / 1000, 0.001) << piece;
  }
}

TEST(TokenBucket, TimeGoingBackwardsCountsAsTheLastTime) {
  TokenBucket bucket(100, 50, kStart);
  bucket.take(50, kStart + 1s);
  EXPECT_EQ(bucket.take(100, kStart), kStart + 2s);
  EXPECT_EQ(bucket.take(0, kStart + 2s), kStart + 2s);
}

TEST(TokenBucket, HugeDebtIsLimitedToABillionSeconds) {
  TokenBucket bucket(1, 1, kStart);
  EXPECT_EQ(bucket.take(~std::uint64_t{0}, kStart), kStart + 1'000'000'000s);
}

}  // namespace
}  // namespace weir::token_bucket_test
