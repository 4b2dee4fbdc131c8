// Values that float32 does not hold. Error bounds include their rounding, and a notice names what no error counts.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "format/base/error.h"
#include "ingest/values/array_source.h"
#include "tests/compressor/support/converted.h"
#include "tests/support/message_of_error.h"

namespace weir::rounding_test {
namespace {

constexpr std::int64_t kEdge = 20;

// Returns a ramp of 0 to 100 plus `offset`.
std::vector<double> ramp(double offset) {
  std::vector<double> values;
  for (std::int64_t i = 0; i < kEdge * kEdge * kEdge; ++i)
    values.push_back(offset + std::fmod(0.37 * static_cast<double>(i), 100));
  return values;
}

test::Converted converted(const std::vector<double>& values, const Budget& budget,
                          NonFinitePolicy non_finite = NonFinitePolicy::error) {
  DenseArray array;
  array.data = values.data();
  array.type = ScalarType::float64;
  array.extent = {kEdge, kEdge, kEdge};
  constexpr std::int64_t kRow = kEdge * static_cast<std::int64_t>(sizeof(double));
  array.stride = {sizeof(double), kRow, kRow * kEdge};
  const auto source = open_array(array);
  ConversionOptions options;
  options.budget = budget;
  options.non_finite = non_finite;
  return test::convert(*source, options);
}

std::string refusal(const std::vector<double>& values, double max_error) {
  return message_of_error(ErrorKind::budget, [&] { converted(values, {Budget::Kind::max_error, 8, 0, max_error}); });
}

TEST(Rounding, BeyondTheBound_IsRefused) {
  const std::vector<double> values = ramp(1e9);
  const std::string message = refusal(values, 0.01);
  EXPECT_TRUE(message.starts_with("memory: float32, which files hold, rounds ")) << message;
  EXPECT_TRUE(message.find(", more than --max-error 0.01 allows; allow --max-error ") != std::string::npos) << message;
  EXPECT_LE(converted(values, {Budget::Kind::max_error, 8, 0, 40}).sidecar.error.max_abs, 40);
}

TEST(Rounding, BoundThatARefusalNames_IsTaken) {
  const std::vector<double> values = ramp(1e6);  // rounded by 0.03 and 2.8e-11, more digits than messages have
  const std::string message = refusal(values, 0.001);
  const std::string remedy = "allow --max-error ";
  const std::size_t at = message.find(remedy);
  ASSERT_NE(at, std::string::npos) << message;
  const double named = std::stod(message.substr(at + remedy.size()));
  EXPECT_LE(converted(values, {Budget::Kind::max_error, 8, 0, named}).sidecar.error.max_abs, named);
}

TEST(Rounding, ThatNoErrorCounts_IsSaidForEveryBudget) {
  const std::vector<double> values = ramp(1e9);
  for (const Budget& budget : {Budget{Budget::Kind::lossless, 8, 0, 0}, Budget{Budget::Kind::psnr, 8, 0, 90},
                               Budget{Budget::Kind::size, 8, 500'000, 0}}) {
    const test::Converted made = converted(values, budget);
    const std::string said = "memory: " + std::to_string(made.sidecar.conversion_loss.inexact) +
                             " values were rounded to float32, which files hold, by up to 32, and no error counts that";
    EXPECT_EQ(std::count(made.notices.begin(), made.notices.end(), said), 1) << budget.target;
  }
}

TEST(Rounding, FarBelowTheError_IsNotSaid) {
  for (const std::string& notice : converted(ramp(0.1), {Budget::Kind::psnr, 8, 0, 50}).notices) {
    EXPECT_EQ(notice.find("rounded"), std::string::npos) << notice;
  }
}

TEST(Rounding, ToInfinity_IsSaid) {
  std::vector<double> values = ramp(0);
  values[7] = 1e300;
  const test::Converted made = converted(values, {Budget::Kind::lossless, 8, 0, 0}, NonFinitePolicy::keep);
  const std::string said = "memory: 1 value is finite but beyond the 3.4e+38 of float32, and infinite in the file";
  EXPECT_EQ(std::count(made.notices.begin(), made.notices.end(), said), 1);
}

}  // namespace
}  // namespace weir::rounding_test
