#include "ingest/plan/staging.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

namespace weir::staging_test {
namespace {

TEST(StagingPool, LendsDistinctAlignedBuffers) {
  StagingPool pool;
  std::vector<std::unique_ptr<StagingPool::Lease>> leases;
  std::vector<std::byte*> starts;
  for (std::size_t i = 0; i < kIoThreads; ++i) {
    leases.push_back(std::make_unique<StagingPool::Lease>(pool));
    const auto bytes = leases.back()->bytes();
    EXPECT_EQ(bytes.size(), kPieceBytes + 2 * kDirectAlignment);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(bytes.data()) % kDirectAlignment, 0U);
    starts.push_back(bytes.data());
  }
  std::sort(starts.begin(), starts.end());
  for (std::size_t i = 1; i < kIoThreads; ++i) {
    EXPECT_GE(static_cast<std::size_t>(starts[i] - starts[i - 1]), kPieceBytes + 2 * kDirectAlignment);
  }
}

TEST(StagingPool, NeverLendsMoreThanItHas) {
  StagingPool pool;
  std::atomic<std::size_t> lent{0};
  std::atomic<std::size_t> most{0};
  {
    std::vector<std::jthread> threads;
    for (std::size_t t = 0; t < 3 * kIoThreads; ++t) {
      threads.emplace_back([&] {
        for (int i = 0; i < 200; ++i) {
          const StagingPool::Lease lease(pool);
          const std::size_t now = ++lent;
          std::size_t before = most;
          while (now > before && !most.compare_exchange_weak(before, now)) {
          }
          lease.bytes().front() = std::byte{1};
          --lent;
        }
      });
    }
  }
  EXPECT_LE(most, kIoThreads);
  EXPECT_EQ(lent, 0U);
}

}  // namespace
}  // namespace weir::staging_test
