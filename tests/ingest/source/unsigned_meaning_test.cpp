#include "ingest/source/unsigned_meaning.h"

#include <gtest/gtest.h>

#include <limits>

namespace weir::unsigned_meaning_test {
namespace {

TEST(UnsignedMeaning, SignedIntegers_HaveTheUnsignedTypeOfTheirWidth) {
  EXPECT_EQ(unsigned_type(ScalarType::int8), ScalarType::uint8);
  EXPECT_EQ(unsigned_type(ScalarType::int64), ScalarType::uint64);
  EXPECT_EQ(unsigned_type(ScalarType::uint16), ScalarType::uint16);
  EXPECT_EQ(unsigned_type(ScalarType::float32), ScalarType::float32);
}

TEST(UnsignedMeaning, NegativeValues_AreThoseOfTheSameBits) {
  EXPECT_EQ(as_unsigned(std::int64_t{-1}, ScalarType::uint8), StoredValue(std::uint64_t{255}));
  EXPECT_EQ(as_unsigned(std::int64_t{-32768}, ScalarType::uint16), StoredValue(std::uint64_t{32768}));
  EXPECT_EQ(as_unsigned(std::int64_t{-1}, ScalarType::uint64), StoredValue(std::numeric_limits<std::uint64_t>::max()));
  EXPECT_EQ(as_unsigned(std::int64_t{7}, ScalarType::uint8), StoredValue(std::int64_t{7}));
}

TEST(UnsignedMeaning, ValuesOfOtherTypes_AreAsTheyAre) {
  EXPECT_EQ(as_unsigned(std::int64_t{-999}, ScalarType::float32), StoredValue(std::int64_t{-999}));
  EXPECT_EQ(as_unsigned(std::int64_t{-1}, ScalarType::int8), StoredValue(std::int64_t{-1}));
  EXPECT_EQ(as_unsigned(-1.5, ScalarType::uint8), StoredValue(-1.5));
}

}  // namespace
}  // namespace weir::unsigned_meaning_test
