#include "ingest/values/decode_values.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

namespace weir::decode_values_test {
namespace {

constexpr bool kNativeIsBig = std::endian::native == std::endian::big;

struct Decoded {
  std::vector<float> values;
  ConversionLoss loss;
};

// Decodes `stored` from unaligned memory in both byte orders, which must agree.
template <typename T>
Decoded decode(const std::vector<T>& stored, ScalarType type, const ValueMapping& mapping) {
  Decoded result;
  for (const bool big : {kNativeIsBig, !kNativeIsBig}) {
    std::vector<std::byte> bytes(1, std::byte{0xEE});
    for (const T& value : stored) {
      const auto* first = reinterpret_cast<const std::byte*>(&value);
      bytes.insert(bytes.end(), first, first + sizeof(T));
      if (big != kNativeIsBig) std::reverse(bytes.end() - sizeof(T), bytes.end());
    }
    Decoded decoded{std::vector<float>(stored.size(), -1.0F), {}};
    decoded.loss = decode_values(std::span(bytes).subspan(1), type, big, mapping, decoded.values);
    if (big == kNativeIsBig) {
      result = decoded;
      continue;
    }
    for (std::size_t i = 0; i < stored.size(); ++i) {
      EXPECT_EQ(std::bit_cast<std::uint32_t>(decoded.values[i]), std::bit_cast<std::uint32_t>(result.values[i])) << i;
    }
    EXPECT_EQ(decoded.loss.inexact, result.loss.inexact);
    EXPECT_EQ(decoded.loss.max_abs_error, result.loss.max_abs_error);
  }
  return result;
}

TEST(DecodeValues, MissingValuesOfEveryTypeAreTold) {
  const ValueMapping mapping{1, 0, {StoredValue{std::int64_t{7}}}};
  const auto expect = [&](const auto& stored, ScalarType type) {
    const Decoded decoded = decode(stored, type, mapping);
    for (std::size_t i = 0; i < stored.size(); ++i) {
      EXPECT_EQ(is_missing(decoded.values[i]), i % 13 == 7) << scalar_name(type) << ' ' << i;
      if (i % 13 != 7) {
        EXPECT_EQ(decoded.values[i], static_cast<float>(i % 13));
      }
    }
    EXPECT_EQ(decoded.loss.inexact, 0U);
  };
  const auto ramp = [](auto zero) {
    std::vector<decltype(zero)> values(1300);  // more than one chunk, and a remainder
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<decltype(zero)>(i % 13);
    return values;
  };
  expect(ramp(std::uint8_t{}), ScalarType::uint8);
  expect(ramp(std::int8_t{}), ScalarType::int8);
  expect(ramp(std::uint16_t{}), ScalarType::uint16);
  expect(ramp(std::int16_t{}), ScalarType::int16);
  expect(ramp(std::uint32_t{}), ScalarType::uint32);
  expect(ramp(std::int32_t{}), ScalarType::int32);
  expect(ramp(std::uint64_t{}), ScalarType::uint64);
  expect(ramp(std::int64_t{}), ScalarType::int64);
  expect(ramp(float{}), ScalarType::float32);
  expect(ramp(double{}), ScalarType::float64);
}

TEST(DecodeValues, SixtyFourBitNeighboursOfTheMissingValueStay) {
  constexpr std::int64_t kFill = -9223372036854775806;  // NetCDF's default fill value of int64
  const Decoded decoded = decode(std::vector<std::int64_t>{kFill, kFill + 1, kFill - 1, 5}, ScalarType::int64,
                                 {1, 0, {StoredValue{kFill}}});
  EXPECT_TRUE(is_missing(decoded.values[0]));
  EXPECT_EQ(decoded.values[1], -0x1p63F);
  EXPECT_EQ(decoded.values[2], -0x1p63F);
  EXPECT_EQ(decoded.values[3], 5.0F);
}

TEST(DecodeValues, MissingCountsAsNoLoss) {
  const Decoded decoded =
      decode(std::vector<double>{1e300, 0.5, 0.1}, ScalarType::float64, {1, 0, {StoredValue{1e300}}});
  EXPECT_TRUE(is_missing(decoded.values[0]));
  EXPECT_EQ(decoded.values[1], 0.5F);
  EXPECT_EQ(decoded.loss.overflow, 0U);
  EXPECT_EQ(decoded.loss.inexact, 1U);
  EXPECT_EQ(decoded.loss.max_abs_error, std::fabs(static_cast<double>(0.1F) - 0.1));
}

TEST(DecodeValues, NaNMayBeTheMissingValue) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  const Decoded decoded = decode(std::vector<float>{nan, -nan, inf, 1}, ScalarType::float32,
                                 {1, 0, {StoredValue{std::numeric_limits<double>::quiet_NaN()}}});
  EXPECT_TRUE(is_missing(decoded.values[0]));
  EXPECT_TRUE(is_missing(decoded.values[1]));
  EXPECT_EQ(decoded.values[2], inf);
  EXPECT_EQ(decoded.values[3], 1.0F);
}

TEST(DecodeValues, AFloatsMissingValueIsComparedRounded) {
  const Decoded decoded =
      decode(std::vector<float>{0.1F, 0.2F}, ScalarType::float32, {1, 0, {*parse_stored_value("0.1")}});
  EXPECT_TRUE(is_missing(decoded.values[0]));
  EXPECT_EQ(decoded.values[1], 0.2F);
}

TEST(DecodeValues, ScaleAndOffsetInDouble) {
  const ValueMapping packed{0.01, 273.15, {StoredValue{std::int64_t{-32767}}}};
  const Decoded decoded = decode(std::vector<std::int16_t>{0, 100, -32767, -32768}, ScalarType::int16, packed);
  EXPECT_EQ(decoded.values[0], 273.15F);
  EXPECT_EQ(decoded.values[1], static_cast<float>(100 * 0.01 + 273.15));
  EXPECT_TRUE(is_missing(decoded.values[2]));  // missing values are compared before scaling
  EXPECT_EQ(decoded.values[3], static_cast<float>(-32768 * 0.01 + 273.15));
  EXPECT_EQ(decoded.loss.inexact, 3U);

  const Decoded exact = decode(std::vector<std::uint8_t>{0, 3, 255}, ScalarType::uint8, {0.5, -1, {}});
  EXPECT_EQ(exact.values, (std::vector<float>{-1.0F, 0.5F, 126.5F}));
  EXPECT_EQ(exact.loss.inexact, 0U);
}

TEST(DecodeValues, HalfFloats) {
  const ValueMapping mapping{2, 0, {StoredValue{std::int64_t{-1}}}};
  const Decoded decoded = decode(std::vector<std::uint16_t>{0x3C00, 0xBC00, 0x7BFF}, ScalarType::float16, mapping);
  EXPECT_EQ(decoded.values[0], 2.0F);
  EXPECT_TRUE(is_missing(decoded.values[1]));
  EXPECT_EQ(decoded.values[2], 131008.0F);

  const Decoded brain = decode(std::vector<std::uint16_t>{0x3F80, 0xBF80, 0x4049}, ScalarType::bfloat16, mapping);
  EXPECT_EQ(brain.values[0], 2.0F);
  EXPECT_TRUE(is_missing(brain.values[1]));
  EXPECT_EQ(brain.values[2], 6.28125F);
}

TEST(DecodeValues, MissingKeptAsData_AreScaledAndCounted) {
  const ValueMapping mapping{0.5, 10, {StoredValue{std::int64_t{-2}}}, true};
  const Decoded decoded = decode(std::vector<std::int16_t>{-2, 4, -2}, ScalarType::int16, mapping);
  EXPECT_EQ(decoded.values, (std::vector<float>{9.0F, 12.0F, 9.0F}));
  EXPECT_EQ(decoded.loss.unmarked, 2U);
  EXPECT_EQ(decoded.loss.inexact, 0U);
}

TEST(DecodeValues, WithoutMappingBytesPassAsTheyAre) {
  const std::vector<std::uint32_t> bits{0x7F800001U, 0x80000000U, kMissingBits};  // a signalling NaN, -0.0
  std::vector<float> values(3);
  decode_values(std::as_bytes(std::span(bits)), ScalarType::float32, kNativeIsBig, {}, values);
  EXPECT_EQ(std::memcmp(values.data(), bits.data(), 12), 0);
}

TEST(DecodeValues, StoredNaNOfTheMissingBits_IsNotMissing) {
  const std::vector<std::uint32_t> bits{kMissingBits, 0xBF800000U, kMissingBits | 0x80000000U};
  std::vector<float> values(3);
  decode_values(std::as_bytes(std::span(bits)), ScalarType::float32, kNativeIsBig, {1, 0, {StoredValue{-1.0}}}, values);
  EXPECT_TRUE(std::isnan(values[0]));
  EXPECT_FALSE(is_missing(values[0]));
  EXPECT_TRUE(is_missing(values[1]));
  EXPECT_FALSE(is_missing(values[2]));
}

TEST(DecodeValues, OfAVolumeWithGaps_NoStoredValueIsOne) {
  const std::vector<std::uint32_t> bits{kMissingBits, 0x3F800000U, 0x7F800000U, 0x7F800001U};
  ValueMapping mapping;
  mapping.gaps = true;
  for (const double scale : {1.0, 2.0}) {
    mapping.scale = scale;
    std::vector<float> values(4);
    decode_values(std::as_bytes(std::span(bits)), ScalarType::float32, kNativeIsBig, mapping, values);
    EXPECT_TRUE(std::isnan(values[0]) && !is_missing(values[0])) << scale;
    EXPECT_EQ(values[1], static_cast<float>(scale));
    EXPECT_TRUE(std::isinf(values[2]));
    EXPECT_TRUE(std::isnan(values[3]));
  }
  mapping.scale = 1;
  mapping.missing = {StoredValue{1.0}};
  std::vector<float> values(4);
  decode_values(std::as_bytes(std::span(bits)), ScalarType::float32, kNativeIsBig, mapping, values);
  EXPECT_FALSE(is_missing(values[0]));
  EXPECT_TRUE(is_missing(values[1]));
  mapping.keeps_missing = true;  // missing values become data, and a stored value still is no gap
  decode_values(std::as_bytes(std::span(bits)), ScalarType::float32, kNativeIsBig, mapping, values);
  EXPECT_TRUE(std::isnan(values[0]) && !is_missing(values[0]));
  EXPECT_EQ(values[1], 1.0F);
}

TEST(DecodeValues, ScaledIntegersOf64Bits_KeepTheirLastBits) {
  constexpr std::int64_t kBase = std::int64_t{1} << 53U;
  std::vector<std::int64_t> stored;
  for (std::int64_t i = 0; i < 600; ++i) stored.push_back(kBase + 1 + i);
  const Decoded shifted = decode(stored, ScalarType::int64, {1, -0x1p53, {}});
  for (std::size_t i = 0; i < stored.size(); ++i) EXPECT_EQ(shifted.values[i], static_cast<float>(i + 1));
  EXPECT_EQ(shifted.loss.inexact, 0U);
  const Decoded high = decode(std::vector<std::uint64_t>{18446744073709551615U, 9223372036854775809U},
                              ScalarType::uint64, {1, -0x1p63, {StoredValue{18446744073709551615U}}});
  EXPECT_TRUE(is_missing(high.values[0]));
  EXPECT_EQ(high.values[1], 1.0F);
}

TEST(DecodeValues, ScaledIntegersOf64Bits_CountWhatFloat32Loses) {
  constexpr std::int64_t kBase = std::int64_t{1} << 53U;
  const Decoded decoded =
      decode(std::vector<std::int64_t>{kBase + 1, kBase + (1 << 25) + 1, 0}, ScalarType::int64, {1, -0x1p53, {}});
  EXPECT_EQ(decoded.values, (std::vector<float>{1, 0x1p25F, -0x1p53F}));
  EXPECT_EQ(decoded.loss.inexact, 1U);
  EXPECT_EQ(decoded.loss.max_abs_error, 1.0);
  const Decoded large = decode(std::vector<std::int64_t>{2, 1}, ScalarType::int64, {3e38, 0, {}});
  EXPECT_TRUE(std::isinf(large.values[0]));
  EXPECT_EQ(large.loss.overflow, 1U);
  EXPECT_EQ(large.loss.inexact, 1U);
}

TEST(DecodeValues, AHalfsMissingValueIsComparedRounded) {
  const ValueMapping mapping{1, 0, {StoredValue{-999.9}, StoredValue{1e6}}};  // float16 cannot hold 1e6
  const Decoded half = decode(std::vector<std::uint16_t>{0xE3D0, 0x3E00, 0x7C00}, ScalarType::float16, mapping);
  EXPECT_TRUE(is_missing(half.values[0])) << half.values[0] << ", -1000 in float16";
  EXPECT_EQ(half.values[1], 1.5F);
  EXPECT_TRUE(std::isinf(half.values[2]));
  const Decoded brain = decode(std::vector<std::uint16_t>{0xC47A, 0x3FC0}, ScalarType::bfloat16, mapping);
  EXPECT_TRUE(is_missing(brain.values[0])) << brain.values[0] << ", -1000 in bfloat16";
  EXPECT_EQ(brain.values[1], 1.5F);
}

}  // namespace
}  // namespace weir::decode_values_test
