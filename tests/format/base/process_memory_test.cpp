#include "format/base/process_memory.h"

#include <gtest/gtest.h>

#include <vector>

namespace weir::process_memory_test {
namespace {

TEST(ProcessMemory, ResidentBytesGrowWithAnAllocation) {
  const std::uint64_t before = resident_bytes();
  constexpr std::size_t kTaken = std::size_t{64} << 20U;
  const std::vector<char> taken(kTaken, 1);
  EXPECT_EQ(taken[kTaken / 2], 1);
  EXPECT_GE(resident_bytes(), before + kTaken - (1U << 20U));
  EXPECT_GE(peak_resident_bytes(), resident_bytes());
}

TEST(ProcessMemory, AvailableBytesArePlausible) {
  EXPECT_GT(available_bytes(), std::uint64_t{1} << 20U);
  EXPECT_LT(available_bytes(), std::uint64_t{1} << 50U);
}

}  // namespace
}  // namespace weir::process_memory_test
