#include "compressor/leaf_mask.h"

#include <gtest/gtest.h>

#include <bitset>
#include <random>

#include "tests/compressor/memory_file_system.h"

namespace weir {
namespace {

TEST(LeafMask, CountsLikeABitset) {
  std::mt19937 random(3);
  for (const unsigned density : {1U, 2U, 64U, 4096U}) {
    LeafMask mask;
    std::bitset<4096> bits;
    EXPECT_TRUE(mask.empty());
    for (std::size_t i = 0; i < 4096; ++i) {
      if (random() % density != 0) continue;
      mask.set(i);
      bits.set(i);
    }
    EXPECT_EQ(mask.count(), bits.count());
    EXPECT_EQ(mask.empty(), bits.none());
    std::uint32_t before = 0;
    for (std::size_t i = 0; i < 4096; ++i) {
      ASSERT_EQ(mask.test(i), bits[i]);
      ASSERT_EQ(mask.count_before(i), before);
      before += bits[i] ? 1 : 0;
    }
  }
}

TEST(MaskStore, GivesBackWhatWasWrittenAndEmptyMasksElsewhere) {
  MaskStore store(test::MemoryFileSystem().create_unnamed("masks"), 5);
  LeafMask mask;
  mask.set(0);
  mask.set(4095);
  store.write(3, mask);
  EXPECT_TRUE(store.read(3).test(0));
  EXPECT_TRUE(store.read(3).test(4095));
  EXPECT_EQ(store.read(3).count(), 2U);
  EXPECT_TRUE(store.read(4).empty());
}

}  // namespace
}  // namespace weir
