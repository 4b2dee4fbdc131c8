#include "ingest/source/stored_value.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace weir::stored_value_test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

TEST(StoredValue, ParsesWholeNumbersAsIntegers) {
  EXPECT_EQ(parse_stored_value("-9999"), StoredValue{std::int64_t{-9999}});
  EXPECT_EQ(parse_stored_value("-9223372036854775808"), StoredValue{std::numeric_limits<std::int64_t>::min()});
  EXPECT_EQ(parse_stored_value("9223372036854775807"), StoredValue{std::numeric_limits<std::int64_t>::max()});
  EXPECT_EQ(parse_stored_value("9223372036854775808"), StoredValue{std::uint64_t{1} << 63U});
  EXPECT_EQ(parse_stored_value("18446744073709551615"), StoredValue{std::numeric_limits<std::uint64_t>::max()});
  EXPECT_EQ(parse_stored_value("18446744073709551616"), StoredValue{0x1p64});
  EXPECT_EQ(parse_stored_value("1e20"), StoredValue{1e20});
  EXPECT_TRUE(std::isnan(std::get<double>(*parse_stored_value("nan"))));
  for (const char* text : {"", " 1", "1 ", "1,5", "none", "0x10"}) EXPECT_FALSE(parse_stored_value(text)) << text;
}

TEST(StoredValue, TextReadsBackAsTheSameValue) {
  for (const char* text : {"-9999", "18446744073709551615", "0.1", "9.969209968386869e+36", "nan", "-inf"}) {
    EXPECT_EQ(stored_value_text(*parse_stored_value(text)), text);
  }
}

TEST(StoredValue, HoldsTellsWhetherATypeCanStoreAValue) {
  EXPECT_TRUE(holds(ScalarType::uint8, StoredValue{std::int64_t{255}}));
  EXPECT_FALSE(holds(ScalarType::uint8, StoredValue{std::int64_t{256}}));
  EXPECT_FALSE(holds(ScalarType::uint8, StoredValue{std::int64_t{-1}}));
  EXPECT_TRUE(holds(ScalarType::int8, StoredValue{-128.0}));
  EXPECT_FALSE(holds(ScalarType::int8, StoredValue{0.5}));
  EXPECT_FALSE(holds(ScalarType::int16, StoredValue{kNaN}));
  EXPECT_FALSE(holds(ScalarType::int64, StoredValue{0x1p63}));
  EXPECT_TRUE(holds(ScalarType::int64, StoredValue{-0x1p63}));
  EXPECT_TRUE(holds(ScalarType::uint64, StoredValue{0x1p63}));
  EXPECT_FALSE(holds(ScalarType::uint64, StoredValue{0x1p64}));
  EXPECT_FALSE(holds(ScalarType::int64, StoredValue{std::numeric_limits<std::uint64_t>::max()}));
  EXPECT_FALSE(holds(ScalarType::float16, StoredValue{1e5}));
  EXPECT_TRUE(holds(ScalarType::bfloat16, StoredValue{3.38e38}));
  EXPECT_FALSE(holds(ScalarType::bfloat16, StoredValue{3.4e38}));
  // The shortest texts of the largest float32, float16 and bfloat16, as other programs write them.
  EXPECT_TRUE(holds(ScalarType::float32, StoredValue{-3.4028235e+38}));
  EXPECT_TRUE(holds(ScalarType::float32, StoredValue{0x1.FFFFFEFFFFFFFp127}));
  EXPECT_FALSE(holds(ScalarType::float32, StoredValue{0x1.FFFFFFp127})) << "rounds to infinity";
  EXPECT_TRUE(holds(ScalarType::float16, StoredValue{6.551e4}));
  EXPECT_FALSE(holds(ScalarType::float16, StoredValue{65520.0}));
  EXPECT_TRUE(holds(ScalarType::bfloat16, StoredValue{3.39e38}));
  EXPECT_TRUE(holds(ScalarType::float32, StoredValue{-kInf}));
  EXPECT_FALSE(holds(ScalarType::float32, StoredValue{1e39}));
  EXPECT_TRUE(holds(ScalarType::float64, StoredValue{1e39}));
}

TEST(StoredValue, MissingIsAQuietNaNOfItsOwn) {
  EXPECT_TRUE(std::isnan(missing_value()));
  EXPECT_TRUE(is_missing(missing_value()));
  EXPECT_FALSE(is_missing(std::numeric_limits<float>::quiet_NaN()));
  EXPECT_FALSE(is_missing(-missing_value()));
  EXPECT_NE(kMissingBits & 0x00400000U, 0U);  // a quiet NaN, so that arithmetic does not trap on it
}

TEST(ValueMapping, DefaultMappingIsTheIdentity) {
  EXPECT_TRUE(ValueMapping{}.identity());
  EXPECT_FALSE((ValueMapping{2, 0, {}}).identity());
  EXPECT_FALSE((ValueMapping{1, 1, {}}).identity());
  EXPECT_FALSE((ValueMapping{1, 0, {StoredValue{kNaN}}}).identity());
  EXPECT_FALSE((ValueMapping{1, 0, {StoredValue{kNaN}}}).scales());
}

}  // namespace
}  // namespace weir::stored_value_test
