#include "ingest/synthetic/pack_values.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <vector>

#include "format/base/error.h"

namespace weir::pack_values_test {
namespace {

template <typename T>
std::vector<T> pack(std::string_view kind, ScalarType type, const std::vector<float>& values) {
  const ValuePacker packer(find_synthetic_kind(kind), type, false);
  std::vector<T> packed(values.size());
  packer.pack(values, std::as_writable_bytes(std::span(packed)));
  return packed;
}

TEST(ValuePacker, UnsignedTypesTakeTheRangeOfTheKind) {
  EXPECT_EQ(pack<std::uint8_t>("cloud", ScalarType::uint8, {0.0F, 0.5F, 1.0F, 0.001F}),
            (std::vector<std::uint8_t>{0, 128, 255, 0}));
  EXPECT_EQ(pack<std::uint16_t>("turbulence", ScalarType::uint16, {-1.0F, 0.0F, 1.0F, 2.0F, -3.0F}),
            (std::vector<std::uint16_t>{0, 32768, 65535, 65535, 0}));
  EXPECT_EQ(pack<std::uint32_t>("noise", ScalarType::uint32, {0.0F, 1.0F}),
            (std::vector<std::uint32_t>{0, 4294967295U}));
}

TEST(ValuePacker, SignedTypesKeepZeroAtZero) {
  EXPECT_EQ(pack<std::int8_t>("cloud", ScalarType::int8, {0.0F, 0.5F, 1.0F}), (std::vector<std::int8_t>{0, 64, 127}));
  EXPECT_EQ(pack<std::int16_t>("turbulence", ScalarType::int16, {-1.0F, -0.0F, 0.5F}),
            (std::vector<std::int16_t>{-32767, 0, 16384}));
  EXPECT_EQ(pack<std::int32_t>("huge", ScalarType::int32, {-3e38F, 3e38F}),
            (std::vector<std::int32_t>{-2147483647, 2147483647}));
}

TEST(ValuePacker, RangesAtBothEndsOfFloat) {
  EXPECT_EQ(pack<std::uint8_t>("denormal", ScalarType::uint8, {0x1p-149F, 0x1p-138F, 0x1p-137F}),
            (std::vector<std::uint8_t>{0, 128, 255}));
  EXPECT_EQ(pack<std::uint8_t>("huge", ScalarType::uint8, {-3e38F, 0.0F, 3e38F}),
            (std::vector<std::uint8_t>{0, 128, 255}));
}

TEST(ValuePacker, KindsWithoutRangeBecomeZero) {
  EXPECT_EQ(pack<std::uint8_t>("negative-zero", ScalarType::uint8, {-0.0F, 0.0F}), (std::vector<std::uint8_t>{0, 0}));
}

TEST(ValuePacker, IntegerKindsKeepTheirValues) {
  EXPECT_EQ(pack<std::int32_t>("big-integer", ScalarType::int32, {16777218.0F}), (std::vector<std::int32_t>{16777218}));
  EXPECT_EQ(pack<std::uint32_t>("offset", ScalarType::uint32, {100000008.0F}), (std::vector<std::uint32_t>{100000008}));
}

TEST(ValuePacker, Float64WidensEveryValue) {
  const float infinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(pack<double>("some-nan", ScalarType::float64, {0.1F, -infinity}),
            (std::vector<double>{static_cast<double>(0.1F), -std::numeric_limits<double>::infinity()}));
}

TEST(ValuePacker, BigEndianSwapsTheBytes) {
  const ValuePacker packer(find_synthetic_kind("cloud"), ScalarType::uint16, true);
  const std::vector<float> values{0x1.02p-8F};  // 0x0102 / 65536, so 257.99 of 65535
  std::vector<std::uint8_t> bytes(2);
  packer.pack(values, std::as_writable_bytes(std::span(bytes)));
  EXPECT_EQ(bytes, (std::vector<std::uint8_t>{0x01, 0x02}));
  EXPECT_FALSE(packer.is_identity());
}

TEST(ValuePacker, NativeFloatsNeedNoPacking) {
  const SyntheticKind& kind = find_synthetic_kind("nan");
  EXPECT_TRUE(ValuePacker(kind, ScalarType::float32, false).is_identity());
  EXPECT_FALSE(ValuePacker(kind, ScalarType::float32, true).is_identity());
  EXPECT_FALSE(ValuePacker(kind, ScalarType::float64, false).is_identity());
}

std::string refusal(std::string_view kind, ScalarType type) {
  try {
    ValuePacker(find_synthetic_kind(kind), type, false);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    return error.what();
  }
  return "no error";
}

TEST(ValuePacker, RefusesWhatATypeCannotHold) {
  EXPECT_EQ(refusal("nan", ScalarType::uint8),
            "kind 'nan' has values that are not finite, which uint8 cannot hold; use --type float32 or float64");
  EXPECT_EQ(
      refusal("big-integer", ScalarType::int16),
      "kind 'big-integer' has integers up to 18874368, which int16 cannot hold; use int32, uint32, float32 or float64");
  EXPECT_EQ(refusal("offset", ScalarType::uint32), "no error");
}

}  // namespace
}  // namespace weir::pack_values_test
