#include "ingest/values/convert_values.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

namespace weir::convert_values_test {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();

template <typename T>
std::vector<std::byte> bytes_of(const std::vector<T>& values, bool swapped) {
  std::vector<std::byte> bytes(values.size() * sizeof(T));
  std::copy_n(reinterpret_cast<const std::byte*>(values.data()), bytes.size(), bytes.data());
  if (swapped) {
    for (std::size_t i = 0; i < bytes.size(); i += sizeof(T)) {
      std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(i),
                   bytes.begin() + static_cast<std::ptrdiff_t>(i + sizeof(T)));
    }
  }
  return bytes;
}

struct Converted {
  std::vector<float> values;
  ConversionLoss loss;
};

/// Converts `values` from unaligned memory in both byte orders. Checks that both results agree bit for bit.
template <typename T>
Converted convert(const std::vector<T>& values, ScalarType type) {
  Converted result;
  for (const bool big : {false, true}) {
    auto bytes = bytes_of(values, big != (std::endian::native == std::endian::big));
    bytes.insert(bytes.begin(), std::byte{0xEE});
    std::vector<float> out(values.size(), -1.0F);
    const ConversionLoss loss = convert_values(std::span(bytes).subspan(1), type, big, out);
    if (!big) {
      result = {out, loss};
      continue;
    }
    EXPECT_EQ(std::memcmp(out.data(), result.values.data(), out.size() * sizeof(float)), 0) << scalar_name(type);
    EXPECT_EQ(loss.inexact, result.loss.inexact);
    EXPECT_EQ(loss.overflow, result.loss.overflow);
    EXPECT_EQ(loss.max_abs_error, result.loss.max_abs_error);
  }
  return result;
}

void expect_lossless(const ConversionLoss& loss) {
  EXPECT_EQ(loss.inexact, 0U);
  EXPECT_EQ(loss.overflow, 0U);
  EXPECT_EQ(loss.max_abs_error, 0.0);
}

/// Checks that every value of an 8- or 16-bit type converts exactly.
template <typename T>
void expect_all_exact(ScalarType type) {
  std::vector<T> values;
  for (std::size_t pattern = 0; pattern < (std::size_t{1} << (8 * sizeof(T))); ++pattern) {
    values.push_back(static_cast<T>(pattern));
  }
  const auto [out, loss] = convert(values, type);
  for (std::size_t i = 0; i < values.size(); ++i) ASSERT_EQ(out[i], static_cast<float>(values[i]));
  expect_lossless(loss);
}

TEST(ConvertValues, SmallIntegersAreExact) {
  expect_all_exact<std::uint8_t>(ScalarType::uint8);
  expect_all_exact<std::int8_t>(ScalarType::int8);
  expect_all_exact<std::uint16_t>(ScalarType::uint16);
  expect_all_exact<std::int16_t>(ScalarType::int16);
}

TEST(ConvertValues, Float32KeepsEveryBit) {
  std::vector<std::uint32_t> bits{0x00000000, 0x80000000, 0x00000001, 0x7f800000, 0xff800000, 0x7fc00000,
                                  0x7f800001,  // signalling NaN
                                  0xffc12345, 0x7f7fffff, 0x3f800000};
  for (std::uint32_t i = 0; i < 40; ++i) bits.push_back(0x40490fdb + i);
  const auto [out, loss] = convert(bits, ScalarType::float32);
  EXPECT_EQ(std::memcmp(out.data(), bits.data(), bits.size() * 4), 0);
  expect_lossless(loss);
}

TEST(ConvertValues, Int32AboveTwoToThe24) {
  const auto exact = convert(std::vector<std::int32_t>{0, -1, 1 << 24, -(1 << 24), std::numeric_limits<int>::min()},
                             ScalarType::int32);
  expect_lossless(exact.loss);
  EXPECT_EQ(exact.values[4], -2147483648.0F);

  // 2^24 + 1 ties to even (2^24), 2^24 + 3 to 2^24 + 4, 2^31 - 1 rounds to 2^31 (error 1), 2^30 + 33 to 2^30 (33).
  const auto rounded = convert(std::vector<std::int32_t>{(1 << 24) + 1, (1 << 24) + 3, 2147483647, (1 << 30) + 33, 7},
                               ScalarType::int32);
  EXPECT_EQ(rounded.values, (std::vector<float>{16777216.0F, 16777220.0F, 2147483648.0F, 1073741824.0F, 7.0F}));
  EXPECT_EQ(rounded.loss.inexact, 4U);
  EXPECT_EQ(rounded.loss.overflow, 0U);
  EXPECT_EQ(rounded.loss.max_abs_error, 33.0);
}

TEST(ConvertValues, Uint32ToItsLimit) {
  const auto [out, loss] =
      convert(std::vector<std::uint32_t>{4294967295U, 4294967040U, 0, 16777217U}, ScalarType::uint32);
  EXPECT_EQ(out, (std::vector<float>{4294967296.0F, 4294967040.0F, 0.0F, 16777216.0F}));
  EXPECT_EQ(loss.inexact, 2U);
  EXPECT_EQ(loss.max_abs_error, 1.0);
}

TEST(ConvertValues, Float64CountsRoundingOverflowAndNothingElse) {
  constexpr double kHuge = std::numeric_limits<double>::max();
  constexpr double kDoubleInf = std::numeric_limits<double>::infinity();
  const double just_below = 0x1.ffffffp127;  // halfway between FLT_MAX and 2^128: overflows
  const double rounds_to_max = std::nextafter(just_below, 0.0);
  const std::vector<double> values{0.1,         0.5,          -0.0,     kHuge, -kHuge,     1e39,          kDoubleInf,
                                   -kDoubleInf, std::nan(""), 0x1p-149, 1e-60, just_below, rounds_to_max, 3e38};
  const auto [out, loss] = convert(values, ScalarType::float64);
  EXPECT_EQ(out[0], 0.1F);
  EXPECT_TRUE(std::signbit(out[2]));
  EXPECT_EQ(out[3], kInf);
  EXPECT_EQ(out[4], -kInf);
  EXPECT_EQ(out[5], kInf);
  EXPECT_EQ(out[6], kInf);
  EXPECT_EQ(out[7], -kInf);
  EXPECT_TRUE(std::isnan(out[8]));
  EXPECT_EQ(out[9], 0x1p-149F);
  EXPECT_EQ(out[10], 0.0F);
  EXPECT_EQ(out[11], kInf);
  EXPECT_EQ(out[12], std::numeric_limits<float>::max());
  EXPECT_EQ(loss.overflow, 4U);  // kHuge, -kHuge, 1e39, just_below
  EXPECT_EQ(loss.inexact, 4U);   // 0.1, 1e-60, rounds_to_max, 3e38
  EXPECT_EQ(loss.max_abs_error, rounds_to_max - static_cast<double>(std::numeric_limits<float>::max()));
}

TEST(ConvertValues, SixtyFourBitIntegers) {
  constexpr std::int64_t kMin = std::numeric_limits<std::int64_t>::min();
  const auto exact = convert(std::vector<std::int64_t>{0, -1, 1 << 24, kMin, std::int64_t{1} << 62}, ScalarType::int64);
  expect_lossless(exact.loss);
  EXPECT_EQ(exact.values[3], -0x1p63F);
  // 2^63 - 1 rounds to 2^63. In a double, the error of 2^53 + 1 would vanish.
  const auto rounded = convert(std::vector<std::int64_t>{-(kMin + 1), (std::int64_t{1} << 53) + 1}, ScalarType::int64);
  EXPECT_EQ(rounded.values, (std::vector<float>{0x1p63F, 0x1p53F}));
  EXPECT_EQ(rounded.loss.inexact, 2U);
  EXPECT_EQ(rounded.loss.max_abs_error, 1.0);
  const auto largest = convert(std::vector<std::uint64_t>{~std::uint64_t{0}, 16777217U}, ScalarType::uint64);
  EXPECT_EQ(largest.values, (std::vector<float>{0x1p64F, 16777216.0F}));
  EXPECT_EQ(largest.loss.inexact, 2U);
}

TEST(ConvertValues, HalfFloatsAreExact) {
  const auto [out, loss] = convert(std::vector<std::uint16_t>{0x0000, 0x8000, 0x0001, 0x03FF, 0x0400, 0x3C00, 0xC000,
                                                              0x7BFF, 0x7C00, 0xFC00, 0x7E01},
                                   ScalarType::float16);
  const std::vector<float> expected{0.0F, -0.0F, 0x1p-24F, 0x1.FF8p-15F, 0x1p-14F, 1.0F, -2.0F, 65504.0F, kInf, -kInf};
  EXPECT_EQ(std::memcmp(out.data(), expected.data(), expected.size() * sizeof(float)), 0);
  EXPECT_EQ(std::bit_cast<std::uint32_t>(out[10]), 0x7FC02000U);
  expect_lossless(loss);
}

TEST(ConvertValues, BFloat16IsExactAndKeepsNaNs) {
  const auto [out, loss] =
      convert(std::vector<std::uint16_t>{0x0000, 0x8000, 0x0001, 0x3F80, 0xC000, 0x7F7F, 0x7F80, 0xFF80, 0x7F81},
              ScalarType::bfloat16);
  const std::vector<float> expected{0.0F, -0.0F, 0x1p-133F, 1.0F, -2.0F, 0x1.FEp127F, kInf, -kInf};
  EXPECT_EQ(std::memcmp(out.data(), expected.data(), expected.size() * sizeof(float)), 0);
  EXPECT_EQ(std::bit_cast<std::uint32_t>(out[8]), 0x7F810000U);  // a signalling NaN stays signalling
  expect_lossless(loss);
}

TEST(ConvertValues, CountsInEveryPlaceOfEveryLength) {
  // The lanes of the vectorised loop count in the same way as the tail after it.
  for (std::size_t n = 1; n <= 50; ++n) {
    for (std::size_t at = 0; at < n; ++at) {
      std::vector<double> values(n, 1.0);
      values[at] = 1.0 + 0x1p-30;
      const auto [out, loss] = convert(values, ScalarType::float64);
      ASSERT_EQ(loss.inexact, 1U) << n << ' ' << at;
      ASSERT_EQ(loss.max_abs_error, 0x1p-30);
      ASSERT_TRUE(std::all_of(out.begin(), out.end(), [](float v) { return v == 1.0F; }));
    }
  }
}

TEST(ConvertValues, EmptyInputHasNoLoss) {
  for (const bool big : {false, true}) {
    expect_lossless(convert_values({}, ScalarType::float32, big, {}));
    expect_lossless(convert_values({}, ScalarType::float64, big, {}));
  }
}

}  // namespace
}  // namespace weir::convert_values_test
