#include "compressor/select/file_size.h"

#include <gtest/gtest.h>

#include "format/base/error.h"

namespace weir::budget_test {
namespace {

SelectionBytes sizes(std::uint64_t minimum, std::uint64_t lossless) {
  SelectionBytes bytes;
  bytes.minimum.file_bytes = minimum;
  bytes.full.file_bytes = lossless;
  return bytes;
}

const SelectionBytes kAny = sizes(1, ~std::uint64_t{0} >> 1U);

std::uint64_t at_rate(std::uint64_t dense, double rate) {
  return file_size_for({Budget::Kind::rate, rate, 0}, dense, kAny, "out").bytes;
}

TEST(Budget, WholeRatesAreExactCeilings) {
  EXPECT_EQ(at_rate(800, 8), 100U);
  EXPECT_EQ(at_rate(801, 8), 101U);
  EXPECT_EQ(at_rate(807, 8), 101U);
  EXPECT_EQ(at_rate(808, 8), 101U);
  EXPECT_EQ(at_rate(809, 8), 102U);
  EXPECT_EQ(at_rate(1, 1000), 1U);
  // Numbers that a double cannot hold exactly.
  EXPECT_EQ(at_rate((std::uint64_t{1} << 60U) + 1, 1), (std::uint64_t{1} << 60U) + 1);
  EXPECT_EQ(at_rate((std::uint64_t{1} << 60U) + 1, 2), (std::uint64_t{1} << 59U) + 1);
}

TEST(Budget, FractionalRatesAreExactCeilingsOfTheDecimalNumber) {
  EXPECT_EQ(at_rate(1000, 2.5), 400U);
  EXPECT_EQ(at_rate(1001, 2.5), 401U);
  // The double 2.3 is a little less than 2.3, but the quotient must not become 41.
  EXPECT_EQ(at_rate(92, 2.3), 40U);
  EXPECT_EQ(at_rate(37, 3.7), 10U);
  EXPECT_EQ(at_rate(1, 0.1), 10U);
  EXPECT_EQ(at_rate(7, 0.001), 7000U);
  EXPECT_EQ(at_rate(100, 1e30), 1U);
  EXPECT_EQ(at_rate(std::uint64_t{1} << 60U, 1.5e18), 1U);
  for (unsigned tenths = 11; tenths < 1000; ++tenths) {
    const double rate = static_cast<double>(tenths) / 10;
    for (const std::uint64_t k : {1U, 12345U, 999'999'937U}) {
      EXPECT_EQ(at_rate(k * tenths, rate), 10 * k) << rate;
      EXPECT_EQ(at_rate(k * tenths + 1, rate), 10 * k + 1) << rate;
      EXPECT_EQ(at_rate(k * tenths - 1, rate), (10 * (k * tenths - 1) + tenths - 1) / tenths) << rate;
    }
  }
}

TEST(Budget, AutomaticIsRateEightOrTheMinimumWithANotice) {
  const FileSize fits = file_size_for({}, 8000, sizes(1000, 5000), "out.nvdb");
  EXPECT_EQ(fits.bytes, 1000U);
  EXPECT_EQ(fits.kind, "rate");
  EXPECT_EQ(fits.notice.text(), "");
  const FileSize tight = file_size_for({}, 7999, sizes(1001, 5000), "out.nvdb");
  EXPECT_EQ(tight.bytes, 1001U);
  EXPECT_EQ(tight.kind, "minimum");
  EXPECT_FALSE(tight.notice.is_remark());
  EXPECT_EQ(tight.notice.text(),
            "out.nvdb: --rate 8 would be 1000 bytes, less than the smallest possible file, 1001 bytes; writing that");
}

TEST(Budget, BelowTheMinimumIsAnErrorThatNamesIt) {
  for (const Budget& budget : {Budget{Budget::Kind::size, 8, 999}, Budget{Budget::Kind::rate, 9.01, 0}}) {
    try {
      file_size_for(budget, 9000, sizes(1000, 5000), "out.nvdb");
      FAIL();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::budget);
      EXPECT_STREQ(error.what(),
                   "out.nvdb: 999 bytes asked, the smallest tree for this volume takes 1000; ask for --size 1000 or "
                   "more");
    }
  }
  EXPECT_EQ(file_size_for({Budget::Kind::size, 8, 1000}, 9000, sizes(1000, 5000), "out").bytes, 1000U);
}

TEST(Budget, MoreThanLosslessIsPaddingWithANotice) {
  const FileSize exact = file_size_for({Budget::Kind::size, 8, 5000}, 9000, sizes(1000, 5000), "out.nvdb");
  EXPECT_EQ(exact.notice.text(), "");
  const FileSize more = file_size_for({Budget::Kind::size, 8, 5001}, 9000, sizes(1000, 5000), "out.nvdb");
  EXPECT_EQ(more.bytes, 5001U);
  EXPECT_EQ(more.kind, "size");
  EXPECT_EQ(
      more.notice.text(),
      "out.nvdb: lossless takes 5000 bytes; the other 1 of the 5001 asked are padding, which --at-most leaves out");
}

TEST(Budget, AtMost_IsAsShortAsTheVolumeNeeds) {
  Budget budget{Budget::Kind::size, 8, 5001};
  budget.at_most = true;
  const FileSize more = file_size_for(budget, 9000, sizes(1000, 5000), "out.nvdb");
  EXPECT_EQ(more.bytes, 5000U);
  EXPECT_EQ(more.kind, "size");
  EXPECT_EQ(more.notice.text(), "out.nvdb: lossless in 5000 bytes; 5001 were allowed");
  EXPECT_TRUE(more.notice.is_remark()) << "it is what was asked for";
  budget.bytes = 4999;
  EXPECT_EQ(file_size_for(budget, 9000, sizes(1000, 5000), "out.nvdb").bytes, 4999U);
}

TEST(Budget, LosslessTakesExactlyTheLosslessSize) {
  const FileSize size = file_size_for({Budget::Kind::lossless, 8, 0}, 9000, sizes(1000, 5000), "out.nvdb");
  EXPECT_EQ(size.bytes, 5000U);
  EXPECT_EQ(size.kind, "lossless");
  EXPECT_EQ(size.notice.text(), "");
}

}  // namespace
}  // namespace weir::budget_test
