#include "compressor/leaf/leaf_lattice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>
#include <vector>

#include "format/leaf/leaf_decode.h"

namespace weir::leaf_lattice_test {
namespace {

std::optional<LeafLattice> lattice_of(const std::vector<float>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const auto lattice = find_lattice(values, *low, *high);
  if (!lattice) return lattice;
  // Every value must come back bit for bit.
  for (const float v : values) {
    const auto code = static_cast<std::uint32_t>(
        std::lround((static_cast<double>(v) - static_cast<double>(*low)) / static_cast<double>(lattice->step)));
    EXPECT_LE(code, lattice->largest);
    EXPECT_EQ(std::bit_cast<std::uint32_t>(dequantize(code, lattice->step, *low)), std::bit_cast<std::uint32_t>(v));
  }
  return lattice;
}

void expect(const std::vector<float>& values, float step, std::uint32_t largest) {
  const auto lattice = lattice_of(values);
  ASSERT_TRUE(lattice);
  EXPECT_EQ(lattice->step, step);
  EXPECT_EQ(lattice->largest, largest);
}

TEST(LeafLattice, WholeNumbers) {
  expect({0, 1, 255}, 1, 255);
  expect({-32768, 32767, 5}, 1, 65535);
  expect({7, 7, 10, 16}, 3, 3);
  expect({16777215, 16777000}, 215, 1);
  expect({-16777215, -16777214}, 1, 1);
  expect({-100, -99, 156}, 1, 256);  // a range beyond the largest magnitude
  expect({-2000, 1, 3000, 2999}, 1, 5000);
  expect({-16777215, 16777215}, 33554430, 1);
  EXPECT_FALSE(lattice_of({-16777215, 16777214}));  // their difference is odd and above 2^24
  EXPECT_FALSE(lattice_of({0, 1, 65536}));
}

TEST(LeafLattice, MultiplesOfAStep) {
  expect({0, 0.25F, 0.75F}, 0.25F, 3);
  expect({100.5F, 101, 103}, 0.5F, 5);
  expect({3e-20F, 3e-20F + std::ldexp(1.0F, -80)}, std::ldexp(1.0F, -80), 1);
  expect({std::ldexp(1.0F, 90), std::ldexp(3.0F, 90)}, std::ldexp(2.0F, 90), 1);
  expect({0, 0.1F}, 0.1F, 1);  // two values always lie on a lattice
}

TEST(LeafLattice, ValuesOffAnyLattice_HaveNone) {
  EXPECT_FALSE(lattice_of({0, 0.1F, 0.35F}));
  EXPECT_FALSE(lattice_of({1e-3F, 1, 0.7F}));
  EXPECT_FALSE(lattice_of({-0.0F, 1, 2}));  // no sum is -0.0
  EXPECT_FALSE(lattice_of({0, -0.0F, 2}));
  EXPECT_FALSE(lattice_of({1e-40F, 3e-40F}));
  EXPECT_FALSE(lattice_of({-3e38F, 3e38F}));
  EXPECT_FALSE(lattice_of({0, 0x1p-80F, 0x1p100F}));  // 2^-80 underflows to 0 in units of the largest value's last bit
  EXPECT_FALSE(lattice_of({0, 0x1p-149F, 0x1p40F}));
  std::mt19937 random(5);
  std::normal_distribution<float> normal(0, 1);
  std::vector<float> noise(512);
  for (float& v : noise) v = normal(random);
  EXPECT_FALSE(lattice_of(noise));
}

TEST(LeafLattice, FindsRandomLattices) {
  std::mt19937 random(7);
  for (int round = 0; round < 300; ++round) {
    const float step = std::ldexp(static_cast<float>(1 + random() % 100), static_cast<int>(random() % 60) - 30);
    const auto levels = static_cast<std::uint32_t>(2 + random() % 2000);
    const float base = step * static_cast<float>(static_cast<int>(random() % 3000) - 1500);
    std::vector<float> values(1 + random() % 510);
    for (float& v : values) v = base + step * static_cast<float>(random() % levels);
    values.push_back(base);
    values.push_back(base + step);  // so that no coarser lattice holds the values
    const auto lattice = lattice_of(values);
    if (base <= 0 && std::signbit(base * 0.0F)) continue;
    ASSERT_TRUE(lattice) << step << ' ' << base;
    EXPECT_EQ(lattice->step, step);
  }
}

TEST(LeafLattice, BitsFor) {
  EXPECT_EQ(bits_for(1), 1U);
  EXPECT_EQ(bits_for(2), 2U);
  EXPECT_EQ(bits_for(3), 2U);
  EXPECT_EQ(bits_for(4), 4U);
  EXPECT_EQ(bits_for(15), 4U);
  EXPECT_EQ(bits_for(16), 8U);
  EXPECT_EQ(bits_for(256), 16U);
  EXPECT_EQ(bits_for(65535), 16U);
}

}  // namespace
}  // namespace weir::leaf_lattice_test
