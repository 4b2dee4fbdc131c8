#include "format/base/doubles8.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>

namespace weir {
namespace {

std::array<double, 8> lanes_of(const Doubles8& v) {
  std::array<double, 8> lanes;
  std::memcpy(lanes.data(), &v, sizeof lanes);
  return lanes;
}

TEST(Doubles8, HasTheLanesOfFloatsAndOfInts) {
  const Floats8 floats = {0.5F, 1, 2, 3, 4, 5, 6, -7.25F};
  const std::array<double, 8> expected = {0.5, 1, 2, 3, 4, 5, 6, -7.25};
  EXPECT_EQ(lanes_of(Doubles8(floats)), expected);
  for (std::size_t l = 0; l < 8; ++l) EXPECT_EQ(Doubles8(floats)[l], expected[l]);
  const Ints8 ints = {-2147483647, 1, 2, 3, 4, 5, 6, 2147483647};
  EXPECT_EQ(lanes_of(Doubles8(ints)), (std::array<double, 8>{-2147483647, 1, 2, 3, 4, 5, 6, 2147483647}));
}

TEST(Doubles8, NarrowsEachLaneAsTheLanguageDoes) {
  const Doubles8 v = Doubles8(Ints8{0, 1, -2, 3, -4, 5, -6, 7}) * 1.75 + 0x1p-30;
  Floats8 floats;
  Ints8 ints;
  narrow(v, floats);
  narrow(v, ints);
  for (int l = 0; l < 8; ++l) {
    EXPECT_EQ(floats[l], static_cast<float>(v[static_cast<std::size_t>(l)])) << l;
    EXPECT_EQ(ints[l], static_cast<int>(v[static_cast<std::size_t>(l)])) << l;
  }
}

TEST(Doubles8, SelectsLaneByLane) {
  const Doubles8 rising(Ints8{0, 1, 2, 3, 4, 5, 6, 7});
  const Doubles8 falling(Ints8{7, 6, 5, 4, 3, 2, 1, 0});
  EXPECT_EQ(lanes_of(select(rising < falling, rising, -falling)), (std::array<double, 8>{0, 1, 2, 3, -3, -2, -1, 0}));
  EXPECT_EQ(lanes_of(select(rising > 6.0, 1.0, 0.0)), (std::array<double, 8>{0, 0, 0, 0, 0, 0, 0, 1}));
  EXPECT_EQ(lanes_of(select(rising >= 6.0, 1.0, 0.0)), (std::array<double, 8>{0, 0, 0, 0, 0, 0, 1, 1}));
}

TEST(Doubles8, MasksNarrowAndWidenLaneByLane) {
  const Doubles8 v(Ints8{0, 9, 0, 9, 9, 0, 0, 9});
  Ints8 mask;
  narrow(v > 1.0, mask);
  for (int l = 0; l < 8; ++l) EXPECT_EQ(mask[l], v[static_cast<std::size_t>(l)] > 1 ? -1 : 0) << l;
  EXPECT_EQ(lanes_of(select(widen(mask) & ~(v > 10.0), v, 1.0)), (std::array<double, 8>{1, 9, 1, 9, 9, 1, 1, 9}));
}

}  // namespace
}  // namespace weir
