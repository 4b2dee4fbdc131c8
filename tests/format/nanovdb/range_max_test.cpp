#include "format/nanovdb/range_max.h"

#include <gtest/gtest.h>

#include <random>

namespace weir::range_max_test {
namespace {

TEST(RangeMax, EqualsTheMaximumOfEveryRange) {
  std::mt19937 random(7);
  for (const std::size_t count : {1U, 2U, 3U, 8U, 13U, 64U, 65U}) {
    std::vector<float> values(count);
    for (float& v : values) v = static_cast<float>(random() % 100) - 50;
    const RangeMax range(values);
    EXPECT_EQ(range.size(), count);
    for (std::size_t first = 0; first < count; ++first) {
      float largest = values[first];
      for (std::size_t last = first; last < count; ++last) {
        largest = std::max(largest, values[last]);
        EXPECT_EQ(range.between(first, last), largest) << count << ": " << first << " to " << last;
      }
    }
  }
}

}  // namespace
}  // namespace weir::range_max_test
