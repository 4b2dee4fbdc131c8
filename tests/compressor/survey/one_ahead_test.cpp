#include "compressor/survey/one_ahead.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <mutex>
#include <stdexcept>
#include <vector>

namespace weir::one_ahead_test {
namespace {

struct Item {
  std::size_t number = 0;
};

TEST(OneAhead, EachItem_IsBegunAndEndedOnce) {
  for (const std::size_t most : {1U, 2U, 5U, 64U}) {
    for (const std::size_t count : {0U, 1U, 2U, 1000U}) {
      std::vector<std::atomic<int>> begun(count);
      std::vector<std::atomic<int>> ended(count);
      one_ahead<Item>(
          count, most,
          [&](std::size_t i, Item& item) {
            item.number = i;
            ++begun[i];
          },
          [&](Item& item) {
            EXPECT_EQ(begun[item.number], 1);
            ++ended[item.number];
          });
      const auto once = [](const std::atomic<int>& times) { return times == 1; };
      EXPECT_TRUE(std::all_of(begun.begin(), begun.end(), once)) << count << " items, " << most << " at once";
      EXPECT_TRUE(std::all_of(ended.begin(), ended.end(), once)) << count << " items, " << most << " at once";
    }
  }
}

TEST(OneAhead, NoMoreAreBegunThanMayBe) {
  for (const std::size_t most : {1U, 2U, 3U, 8U}) {
    std::mutex mutex;
    std::size_t open = 0;
    std::size_t highest = 0;
    one_ahead<Item>(
        500, most,
        [&](std::size_t, Item&) {
          const std::lock_guard lock(mutex);
          highest = std::max(highest, ++open);
        },
        [&](Item&) {
          const std::lock_guard lock(mutex);
          --open;
        });
    EXPECT_EQ(open, 0U);
    EXPECT_LE(highest, std::max<std::size_t>(2, most)) << most;
  }
}

TEST(OneAhead, AfterAnException_NothingIsBegun) {
  std::atomic<std::size_t> begun = 0;
  const auto run = [&] {
    one_ahead<Item>(
        100'000, 4,
        [&](std::size_t i, Item&) {
          ++begun;
          if (i == 10) throw std::runtime_error("the device is gone");
        },
        [](Item&) {});
  };
  EXPECT_THROW(run(), std::runtime_error);
  EXPECT_LT(begun, 100'000U);
}

}  // namespace
}  // namespace weir::one_ahead_test
