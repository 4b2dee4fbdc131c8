#include "ingest/raw/raw_name.h"

#include <gtest/gtest.h>

#include <limits>

namespace weir::raw_name_test {
namespace {

TEST(RawName, ReadsExtentAndType) {
  const auto name = parse_raw_name("/data/x_1x2x3_y/aneurism_256x128x64_uint8.raw");
  ASSERT_TRUE(name);
  EXPECT_EQ(name->name, "aneurism");
  EXPECT_EQ(name->extent, (Index3{256, 128, 64}));
  EXPECT_EQ(name->type, ScalarType::uint8);
  EXPECT_FALSE(name->big_endian);
}

TEST(RawName, KeepsUnderscoresOfTheName) {
  const auto name = parse_raw_name("mni152_2009_193x229x193_int16.raw");
  ASSERT_TRUE(name);
  EXPECT_EQ(name->name, "mni152_2009");
  EXPECT_EQ(name->type, ScalarType::int16);
}

TEST(RawName, BigEndianSuffixBelongsToTheType) {
  const auto name = parse_raw_name("carotid_76x49x45_float32be.raw");
  ASSERT_TRUE(name);
  EXPECT_EQ(name->type, ScalarType::float32);
  EXPECT_TRUE(name->big_endian);
  EXPECT_EQ(name->type_text, "float32be");
}

TEST(RawName, AllScalarTypes) {
  for (const char* type : {"uint8", "int8", "uint16", "int16", "uint32", "int32", "float32", "float64"}) {
    const auto name = parse_raw_name(std::string("a_1x1x1_") + type + ".raw");
    ASSERT_TRUE(name && name->type) << type;
    EXPECT_EQ(scalar_name(*name->type), type);
  }
}

// Option --type takes the same names of types.
TEST(RawName, TypesOfCAndNumpy_AreTaken) {
  const auto expect = [](const std::string& text, ScalarType type, bool big_endian) {
    const auto name = parse_raw_name("a_4x4x4_" + text + ".raw");
    ASSERT_TRUE(name) << text;
    EXPECT_EQ(name->type, type) << text;
    EXPECT_EQ(name->big_endian, big_endian) << text;
    EXPECT_EQ(name->type_text, text);
  };
  expect("float", ScalarType::float32, false);
  expect("double", ScalarType::float64, false);
  expect("f4", ScalarType::float32, false);
  expect("u2be", ScalarType::uint16, true);
  expect("<f8", ScalarType::float64, false);
  expect(">i2", ScalarType::int16, true);
}

TEST(RawName, UnknownTypeIsReportedAsWritten) {
  const auto name = parse_raw_name("a_4x4x4_real.raw");
  ASSERT_TRUE(name);
  EXPECT_FALSE(name->type);
  EXPECT_EQ(name->type_text, "real");
}

TEST(RawName, ImpossibleExtentsAreReadAsWritten) {
  EXPECT_EQ(parse_raw_name("a_0x4x-4_uint8.raw")->extent, (Index3{0, 4, -4}));
  constexpr auto kMax = std::numeric_limits<std::int64_t>::max();
  constexpr auto kMin = std::numeric_limits<std::int64_t>::min();
  EXPECT_EQ(parse_raw_name("a_99999999999999999999x1x-99999999999999999999_uint8.raw")->extent,
            (Index3{kMax, 1, kMin}));
}

// Scanners write such names under Windows.
TEST(RawName, ExtensionInCapitals_IsTaken) {
  const auto name = parse_raw_name("Scan_4x5x6_uint16be.RAW");
  ASSERT_TRUE(name);
  EXPECT_EQ(name->name, "Scan");
  EXPECT_EQ(name->extent, (Index3{4, 5, 6}));
  EXPECT_EQ(name->type, ScalarType::uint16);
  EXPECT_TRUE(name->big_endian);
}

TEST(RawName, UnrecognisedNamesGiveNothing) {
  for (const char* path :
       {"", "raw", ".raw", "a.raw", "a_uint8.raw", "4x4x4_uint8.raw", "_4x4x4_uint8.raw", "a_4x4_uint8.raw",
        "a_4x4x4x4_uint8.raw", "a_4x4x_uint8.raw", "a_4x 4x4_uint8.raw", "a_+4x4x4_uint8.raw", "a_4X4X4_uint8.raw",
        "a_4x4x4_uint8.raw.xz", "a_4x4x4_uint8", "a_4x4x4.raw", "a_4x4x4_uint8.raw/"}) {
    EXPECT_FALSE(parse_raw_name(path)) << path;
  }
}

}  // namespace
}  // namespace weir::raw_name_test
