#include "format/packed/row_lanes.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace weir::row_lanes_test {
namespace {

using packed_detail::Contexts;
using packed_detail::OneRow;

unsigned level_of(std::uint32_t t) { return t < kLevelSums ? kBlockScan.level[t] : kPackedLevels - 1; }

template <typename Lanes>
[[gnu::always_inline]] inline void expect_contexts_of(std::uint32_t first, std::uint32_t end) {
  using Ints = typename Lanes::Ints;
  constexpr unsigned kLanes = sizeof(Ints) / sizeof(std::int32_t);
  const Contexts<Lanes> contexts;
  for (std::uint32_t t = first; t < end; t += kLanes) {
    Ints sums;
    for (unsigned l = 0; l < kLanes; ++l) sums[l] = static_cast<std::int32_t>(t + l);
    Ints level;
    Ints extra;
    contexts.find(sums, level, extra);
    for (unsigned l = 0; l < kLanes; ++l) {
      ASSERT_EQ(static_cast<unsigned>(level[l]), level_of(t + l)) << t + l;
      ASSERT_EQ(static_cast<unsigned>(extra[l]), extra_bits(t + l)) << t + l;
    }
  }
}

constexpr std::uint32_t kBeyondLast = 1U << 21U;  // the last threshold is 18 * 2^16
constexpr std::uint32_t kLargest = 6U << 23U;

TEST(RowLanes, ContextsOfEverySumEqualTheFormats) {
  expect_contexts_of<OneRow>(0, kBeyondLast);
  expect_contexts_of<OneRow>(kLargest - 64, kLargest);
}

#ifdef WEIR_SIMD_PATHS
__attribute__((target("avx512f"))) void expect_contexts_of_two_rows() {
  expect_contexts_of<packed_detail::TwoRows>(0, kBeyondLast);
  expect_contexts_of<packed_detail::TwoRows>(kLargest - 64, kLargest);
}

TEST(RowLanes, ContextsOfTwoRowsEqualTheFormats) {
  if (!packed_detail::has_avx512()) GTEST_SKIP() << "no AVX-512";
  expect_contexts_of_two_rows();
}
#endif

}  // namespace
}  // namespace weir::row_lanes_test
