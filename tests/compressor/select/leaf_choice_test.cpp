#include "compressor/select/leaf_choice.h"

#include <gtest/gtest.h>

#include <array>
#include <random>

#include "tests/compressor/support/crash_file_system.h"

namespace weir::leaf_choice_test {
namespace {

TEST(LeafWidth, BytesAreThoseOfTheFormat) {
  EXPECT_EQ(leaf_bytes(LeafWidth::tile), 0U);
  EXPECT_EQ(leaf_bytes(LeafWidth::bits1), 160U);
  EXPECT_EQ(leaf_bytes(LeafWidth::bits2), 224U);
  EXPECT_EQ(leaf_bytes(LeafWidth::bits4), 352U);
  EXPECT_EQ(leaf_bytes(LeafWidth::bits8), 608U);
  EXPECT_EQ(leaf_bytes(LeafWidth::bits16), 1120U);
  EXPECT_EQ(leaf_bytes(LeafWidth::float32), 2144U);
  for (unsigned log2 = 0; log2 < 6; ++log2) EXPECT_EQ(bits_log2_of(width_of(log2)), log2);
}

TEST(LeafPlaces, CountsAgreeWithALinearScan) {
  std::mt19937 random(3);
  for (const unsigned density : {1U, 2U, 64U, 4096U}) {
    LeafChoices choices;
    std::array<LeafWidth, LeafChoices::kLeaves> widths{};
    for (std::size_t i = 0; i < widths.size(); ++i) {
      if (random() % density != 0) continue;
      choices.set(i, LeafWidth::float32);  // a second choice replaces the first
      widths[i] = static_cast<LeafWidth>(random() % 7);
      choices.set(i, widths[i]);
    }
    const LeafPlaces places(choices);
    LeafPlaces::Place before;
    for (std::size_t i = 0; i < widths.size(); ++i) {
      ASSERT_EQ(choices.width(i), widths[i]);
      ASSERT_EQ(places.kept(i), widths[i] != LeafWidth::tile);
      ASSERT_EQ(places.before(i).leaves, before.leaves);
      ASSERT_EQ(places.before(i).bytes, before.bytes);
      before.leaves += places.kept(i) ? 1 : 0;
      before.bytes += leaf_bytes(widths[i]);
    }
    EXPECT_EQ(places.total().leaves, before.leaves);
    EXPECT_EQ(places.total().bytes, before.bytes);
  }
}

TEST(ChoiceStore, ReadsBackChoicesAndTilesWhereUnwritten) {
  ChoiceStore store(test::CrashFileSystem().create_unnamed("choices"), 5);
  LeafChoices choices;
  choices.set(0, LeafWidth::bits1);
  choices.set(4095, LeafWidth::bits16);
  store.write(3, choices);
  EXPECT_EQ(store.read(3).width(0), LeafWidth::bits1);
  EXPECT_EQ(store.read(3).width(4095), LeafWidth::bits16);
  EXPECT_EQ(LeafPlaces(store.read(3)).total().leaves, 2U);
  EXPECT_EQ(LeafPlaces(store.read(4)).total().leaves, 0U);
}

}  // namespace
}  // namespace weir::leaf_choice_test
