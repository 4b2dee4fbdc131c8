#include "ingest/values/decode_component.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace weir::decode_component_test {
namespace {

constexpr ComponentChoice kMagnitude{true, 0};

template <typename T>
std::vector<float> decoded(const std::vector<T>& numbers, ScalarType type, const VoxelComponents& components,
                           const ValueMapping& mapping = {}, ConversionLoss* loss = nullptr) {
  std::vector<float> values(numbers.size() / static_cast<std::size_t>(components.count));
  const ConversionLoss lost =
      decode_component(std::as_bytes(std::span(numbers)), type, kNativeIsBig, mapping, components, values);
  if (loss != nullptr) *loss = lost;
  return values;
}

TEST(DecodeComponent, OneComponentIsEveryThirdNumber) {
  std::vector<std::int16_t> numbers;
  for (std::int16_t i = 0; i < 3 * 1000; ++i) numbers.push_back(i);
  const std::vector<float> values = decoded(numbers, ScalarType::int16, {3, {false, 2}});
  ASSERT_EQ(values.size(), 1000U);
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(values[i], static_cast<float>(3 * i + 2));
}

TEST(DecodeComponent, MagnitudeIsTheRootOfTheSumOfSquares) {
  EXPECT_EQ(decoded(std::vector<float>{3, 4, 0, -2, -3, 6}, ScalarType::float32, {3, kMagnitude}),
            (std::vector<float>{5, 7}));
  EXPECT_EQ(decoded(std::vector<std::uint8_t>{3, 4, 6, 8}, ScalarType::uint8, {2, kMagnitude}, {0.5, 0, {}}),
            (std::vector<float>{2.5F, 5}));
}

TEST(DecodeComponent, MagnitudeOfDoublesIsComputedInDouble) {
  const double small = 1e-30;  // its square is too small for float32
  ConversionLoss loss;
  EXPECT_EQ(
      decoded(std::vector<double>{3 * small, 4 * small, 3e200, 4e200}, ScalarType::float64, {2, kMagnitude}, {}, &loss),
      (std::vector<float>{static_cast<float>(std::sqrt(9 * small * small + 16 * small * small)),
                          std::numeric_limits<float>::infinity()}));
  EXPECT_EQ(loss.overflow, 1U);
  EXPECT_EQ(loss.inexact, 1U);
}

TEST(DecodeComponent, MagnitudeOfScaledIntegersOf64Bits_KeepsTheirLastBits) {
  constexpr std::int64_t kBase = std::int64_t{1} << 53U;
  EXPECT_EQ(
      decoded(std::vector<std::int64_t>{kBase + 3, kBase + 4}, ScalarType::int64, {2, kMagnitude}, {1, -0x1p53, {}}),
      std::vector<float>{5});
}

TEST(DecodeComponent, LossIsCountedForTheChosenComponentOnly) {
  ConversionLoss loss;
  decoded(std::vector<double>{0.5, 0.1, 0.25, 0.2}, ScalarType::float64, {2, {false, 0}}, {}, &loss);
  EXPECT_EQ(loss.inexact, 0U);
  decoded(std::vector<double>{0.5, 0.1, 0.25, 0.2}, ScalarType::float64, {2, {false, 1}}, {}, &loss);
  EXPECT_EQ(loss.inexact, 2U);
}

TEST(DecodeComponent, MagnitudeWithAMissingComponentIsMissing) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> values =
      decoded(std::vector<float>{3, -99, -nan, 1, 3, 4}, ScalarType::float32, {2, kMagnitude}, {1, 0, {-99.0}});
  EXPECT_TRUE(is_missing(values[0]));
  EXPECT_EQ(std::bit_cast<std::uint32_t>(values[1]), 0x7FC00000U);
  EXPECT_EQ(values[2], 5.0F);
}

TEST(DecodeComponent, MagnitudeOfMissingValuesKeptAsData_IsCountedOncePerVoxel) {
  ConversionLoss loss;
  const std::vector<float> values = decoded(std::vector<float>{3, 4, -3, 4, -3, -3}, ScalarType::float32,
                                            {2, kMagnitude}, {1, 0, {-3.0}, true}, &loss);
  EXPECT_EQ(values, (std::vector<float>{5, 5, static_cast<float>(std::sqrt(18.0))}));
  EXPECT_EQ(loss.unmarked, 2U);
}

}  // namespace
}  // namespace weir::decode_component_test
