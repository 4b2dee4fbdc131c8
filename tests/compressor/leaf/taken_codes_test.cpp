#include "compressor/leaf/taken_codes.h"

#include <gtest/gtest.h>

#include <vector>

namespace weir::taken_codes_test {
namespace {

TEST(TakenCodes, CountsThoseThatMoreThanAFewHave) {
  // Code c occurs c times.
  for (const unsigned bits : {1U, 2U, 4U}) {
    std::vector<std::uint16_t> codes;
    const unsigned end = 1U << bits;
    for (unsigned code = 0; code < end; ++code) codes.insert(codes.end(), code, static_cast<std::uint16_t>(code));
    for (unsigned few = 0; few < end; ++few) EXPECT_EQ(taken_codes(codes, bits, few), end - 1 - few) << bits;
  }
}

TEST(TakenCodes, CountsAllOfEightBits) {
  std::vector<std::uint16_t> codes;
  for (unsigned i = 0; i < 512; ++i) codes.push_back(static_cast<std::uint16_t>(i % 256));
  EXPECT_EQ(taken_codes(codes, 8, 0), 256U);
  EXPECT_EQ(taken_codes(codes, 8, 1), 256U);
  EXPECT_EQ(taken_codes(codes, 8, 2), 0U);
  codes[7] = 255;
  EXPECT_EQ(taken_codes(codes, 8, 1), 255U);
}

TEST(TakenCodes, ALeafOfOneCodeTakesOne) {
  const std::vector<std::uint16_t> codes(512, 3);
  EXPECT_EQ(taken_codes(codes, 2, 511), 1U);
  EXPECT_EQ(taken_codes(codes, 2, 512), 0U);
  EXPECT_EQ(taken_codes({}, 4, 0), 0U);
}

}  // namespace
}  // namespace weir::taken_codes_test
