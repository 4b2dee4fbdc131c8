#include "daemon/jobs/job_figures.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <string>

namespace weir::job_figures_test {
namespace {

using Errors = std::map<std::string, std::uint64_t>;

// A time series that begins with its first error gives no rate of this error.
TEST(JobTotals, AtTheStart_HaveEveryKindOfErrorAtZero) {
  const Errors expected{{"input", 0},    {"io", 0},     {"budget", 0},    {"usage", 0},
                        {"internal", 0}, {"killed", 0}, {"disk-full", 0}, {"source-changed", 0}};
  EXPECT_EQ(JobTotals{}.errors, expected);
  JobFigures figures;
  figures.attempt_failed("io");
  EXPECT_EQ(figures.totals().errors.at("io"), 1U);
  EXPECT_EQ(figures.totals().errors.size(), expected.size());
}

}  // namespace
}  // namespace weir::job_figures_test
