#include "compressor/select/float_bound.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <vector>

#include "compressor/resume/work_directory.h"
#include "compressor/select/encoding_choice.h"
#include "ingest/synthetic/synthetic.h"
#include "tests/compressor/support/crash_file_system.h"
#include "tests/compressor/support/hard_cases.h"
#include "tests/compressor/support/surveyed.h"

namespace weir::float_bound_test {
namespace {

using test::Chooser;
using test::MemoryVolume;
using test::Surveyed;

constexpr std::uint64_t kLeafBytes = leaf_bytes(LeafWidth::float32);
constexpr double kRounding = 1e-5;

MemoryVolume turbulence(const Index3& dims) {
  const auto source = open_synthetic("turbulence", {dims, 1});
  return MemoryVolume(*source);
}

// Returns the squared deviations of the leaves from their means in falling order.
std::vector<double> falling_errors(const Surveyed& surveyed) {
  std::vector<double> errors;
  for (const LeafRow& row : surveyed.all_rows()) errors.push_back(row.sse);
  std::sort(errors.begin(), errors.end(), std::greater<>());
  return errors;
}

double sum_from(const std::vector<double>& errors, std::size_t first) {
  return std::accumulate(errors.begin() + static_cast<std::ptrdiff_t>(first), errors.end(), 0.0);
}

TEST(FloatBound, IsWhatTheLeavesOfTheSmallestErrorsLose) {
  MemoryVolume volume = turbulence({72, 40, 40});
  const Surveyed surveyed(volume);
  const FloatBound bound(TreeRegions(volume.info().domain()), surveyed.rows);
  const std::vector<double> errors = falling_errors(surveyed);
  ASSERT_EQ(errors.size(), 225U);
  for (std::size_t kept = 0; kept <= errors.size(); ++kept) {
    SCOPED_TRACE(kept);
    const double exact = sum_from(errors, kept);
    const double least = bound.least_error(kept * kLeafBytes + kLeafBytes - 1);
    EXPECT_LE(least, exact);
    EXPECT_GE(least, exact / 1.5 * (1 - kRounding));  // the errors of a class's kept leaves are not known one by one
  }
  EXPECT_GE(bound.least_error(0), sum_from(errors, 0) * (1 - kRounding));
  EXPECT_EQ(bound.least_error(errors.size() * kLeafBytes), 0);
}

TEST(FloatBound, IsTheBytesOfTheFewestLeavesForAnError) {
  MemoryVolume volume = turbulence({72, 40, 40});
  const Surveyed surveyed(volume);
  const FloatBound bound(TreeRegions(volume.info().domain()), surveyed.rows);
  const std::vector<double> errors = falling_errors(surveyed);
  const auto fewest = [&](double error) {
    std::size_t kept = errors.size();
    while (kept > 0 && sum_from(errors, kept - 1) <= error) --kept;
    return kept * kLeafBytes;
  };
  const double all = sum_from(errors, 0);
  for (int part = 0; part <= 100; ++part) {
    SCOPED_TRACE(part);
    const double error = all * part / 100;
    EXPECT_LE(bound.least_bytes(error), fewest(error));
    EXPECT_GE(bound.least_bytes(error), fewest(1.5 * error * (1 + kRounding)));
  }
  EXPECT_EQ(bound.least_bytes(0), errors.size() * kLeafBytes);
  EXPECT_EQ(bound.least_bytes(all), 0U);
}

TEST(FloatBound, NoFloatFileIsBelowIt) {
  for (const test::HardCase& hard : test::hard_cases()) {
    MemoryVolume volume = hard.make();
    if (test::policies_of(volume).front() != NonFinitePolicy::error) continue;
    const Surveyed surveyed(volume);
    for (const FillMode mode : {FillMode::mean, FillMode::background}) {
      GainRule rule;
      rule.fill.mode = mode;
      Chooser chooser(surveyed, rule);
      const FloatBound bound(chooser.tree(), surveyed.rows);
      for (std::uint64_t part = 0; part <= 8; ++part) {
        const std::uint64_t size = chooser.minimum() + (chooser.lossless() - chooser.minimum()) * part / 8;
        const double error = chooser.choose(size).plan.expected_error;
        EXPECT_GE(error, bound.least_error(size)) << hard.name << ", " << size;
        EXPECT_GE(size, bound.least_bytes(error)) << hard.name << ", " << error;
      }
    }
  }
}

// A volume with its survey for quantised leaves, and plans of files for it.
class Planned {
 public:
  Planned()
      : plan_(plan_blocks(volume_.info().domain(), volume_.access(), std::uint64_t{1} << 30U)),
        rows_(files_.create_unnamed("rows"), plan_.lattice, {64, std::uint64_t{1} << 24U}),
        survey_(survey_volume(volume_, plan_, rows_, {}, {.widths = true})) {}

  FilePlan plan(const Budget& budget, double squared_error, bool plans_float) {
    FileRequest request;
    request.encoding = Encoding::automatic;
    request.budget = budget;
    request.squared_error = request.planned_error = squared_error;
    request.domain = volume_.info().domain();
    request.plans_float = plans_float;
    request.path = "out.nvdb";
    return plan_file(request, rows_, work_);
  }

 private:
  test::CrashFileSystem files_;
  MemoryVolume volume_ = turbulence({64, 64, 64});
  BlockPlan plan_;
  RowStore rows_;
  Survey survey_;
  WorkDirectory work_{files_, "out.nvdb", ""};
};

TEST(FloatBound, SparesThePlanOfTheFloatFile) {
  Planned planned;
  const Budget budget{Budget::Kind::size, 8, 600'000};
  const FilePlan bounded = planned.plan(budget, 0, false);
  const FilePlan whole = planned.plan(budget, 0, true);
  EXPECT_TRUE(bounded.float_error_is_bound);
  EXPECT_FALSE(whole.float_error_is_bound);
  EXPECT_EQ(bounded.encoding, Encoding::fpn);
  EXPECT_EQ(whole.encoding, Encoding::fpn);
  EXPECT_EQ(bounded.plan.expected_error, whole.plan.expected_error);
  EXPECT_LE(bounded.float_error, whole.float_error);
  EXPECT_GT(bounded.float_error, 0);
  EXPECT_LT(whole.float_error, std::numeric_limits<double>::infinity());
}

TEST(FloatBound, ChoosesTheSameEncodingForAnErrorAsThePlanOfBothFiles) {
  Planned planned;
  for (const double error : {1e4, 1e2, 1.0, 1e-2, 1e-4, 1e-6, 1e-8, 0.0}) {
    SCOPED_TRACE(error);
    const Budget budget{Budget::Kind::psnr, 8, 0, 60};
    const FilePlan bounded = planned.plan(budget, error, false);
    const FilePlan whole = planned.plan(budget, error, true);
    EXPECT_EQ(bounded.encoding, whole.encoding);
    EXPECT_EQ(bounded.size.bytes, whole.size.bytes);
  }
}

}  // namespace
}  // namespace weir::float_bound_test
