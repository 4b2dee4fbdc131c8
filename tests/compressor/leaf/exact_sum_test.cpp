#include "compressor/leaf/exact_sum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace weir::exact_sum_test {
namespace {

double sum_of(const std::vector<double>& terms) {
  ExactSum sum;
  for (const double term : terms) sum.add(term);
  return sum.value();
}

TEST(ExactSum, EmptySumIsZero) { EXPECT_EQ(ExactSum().value(), 0.0); }

TEST(ExactSum, SumOfOneTermIsThatTerm) {
  for (const double term : {0.0, 1.0, 1.0 / 3.0, std::numeric_limits<double>::denorm_min(),
                            std::numeric_limits<double>::min(), 4.6e77, std::numeric_limits<double>::max(), 0x1p-1022,
                            0x1.fffffffffffffp-1000, 0x1.fffffffffffffp31, 0x1.0000000000001p32}) {
    EXPECT_EQ(sum_of({term}), term) << term;
  }
}

TEST(ExactSum, SmallTermsAreNotLostInALargeOne) {
  std::vector<double> terms{0x1p60};
  terms.insert(terms.end(), 4096, 0x1p-4);
  EXPECT_EQ(sum_of(terms), 0x1p60 + 256.0);
  EXPECT_EQ(sum_of({1e300, 1e-300, 1e300}), 2e300);
}

TEST(ExactSum, OrderAndGroupingDoNotMatter) {
  std::vector<double> terms;
  double term = 1.0;
  for (int i = 0; i < 4000; ++i) {
    term = term * 1.37 + 1e-3;
    if (term > 1e200) term *= 1e-220;
    terms.push_back(term);
  }
  const double forwards = sum_of(terms);
  std::reverse(terms.begin(), terms.end());
  EXPECT_EQ(sum_of(terms), forwards);
  std::sort(terms.begin(), terms.end());
  EXPECT_EQ(sum_of(terms), forwards);
  ExactSum left;
  ExactSum right;
  for (std::size_t i = 0; i < terms.size(); ++i) (i % 3 == 0 ? left : right).add(terms[i]);
  left.add(right);
  EXPECT_EQ(left.value(), forwards);
}

TEST(ExactSum, CarriesPropagateAcrossAllDigits) {
  ExactSum sum;
  sum.add(0x1p40 - 0x1p-12);
  sum.add(0x1p-12);
  EXPECT_EQ(sum.value(), 0x1p40);
  // Doubling by merging: 2^40 terms of 2^-20.
  ExactSum doubled;
  doubled.add(0x1p-20);
  for (int i = 0; i < 40; ++i) doubled.add(ExactSum(doubled));
  EXPECT_EQ(doubled.value(), 0x1p20);
}

}  // namespace
}  // namespace weir::exact_sum_test
