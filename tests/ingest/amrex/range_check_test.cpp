// Tests the notice about values outside the ranges that Cell_H states.
#include "ingest/amrex/range_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "ingest/source_registry.h"
#include "tests/ingest/support/scratch.h"
#include "tests/support/plotfile_writer.h"
#include "tests/support/run_command.h"

namespace weir::range_check_test {
namespace {

using test::PlotfilePlan;

class RangeCheck : public testing::Test {
 protected:
  /// Reads all of `component` twice. Returns the notices of both reads.
  std::vector<std::string> lines(const std::string& component) const {
    std::vector<std::string> said;
    SourceOptions options;
    options.dataset = component;
    options.notice = [&](const Message& line) { said.push_back(line.text()); };
    const auto source = open_source(path_, options);
    std::vector<float> values(static_cast<std::size_t>(source->info().domain().voxels()));
    for (int pass = 0; pass < 2; ++pass) source->read(source->info().domain(), values);
    return said;
  }

  /// Sets the first value of the first component in `file`, which holds a single FAB.
  template <typename T>
  void set_first(const std::string& file, T value) const {
    std::string bytes = read_file(path_ + '/' + file);
    std::memcpy(bytes.data() + bytes.find('\n') + 1, &value, sizeof value);
    write_file(path_ + '/' + file, bytes);
  }

  Scratch scratch_;
  std::string path_ = scratch_.path("plt00042");
};

/// Returns values that are exact neither in float32 nor as decimal numbers of a few digits.
double wave(std::size_t level, std::size_t component, const Index3& cell) {
  return std::sin(static_cast<double>(cell.x + 3 * cell.y + 7 * cell.z)) *
             std::pow(10.0, 3 * static_cast<double>(component)) -
         static_cast<double>(level) / 3;
}

PlotfilePlan two_boxes() {
  PlotfilePlan plan;
  plan.components = {"density", "Temp"};
  plan.domain = {{2, 0, 0}, {10, 4, 4}};
  plan.boxes = {{{{2, 0, 0}, {6, 4, 4}}, {{6, 0, 0}, {10, 4, 4}}}};
  plan.fabs_per_file = 1;
  plan.value = wave;
  return plan;
}

TEST_F(RangeCheck, ValueOutside_IsSaidOnceWithItsBoxAndFiles) {
  test::write_plotfile(path_, two_boxes());
  EXPECT_EQ(lines("density"), std::vector<std::string>{});
  set_first("Level_0/Cell_D_00001", 4.5);
  const std::vector<std::string> said = lines("density");
  ASSERT_EQ(said.size(), 1U);
  EXPECT_TRUE(said[0].starts_with(path_ + "/Level_0/Cell_D_00001: box (6,0,0) to (9,3,3) has 4.5 in density, and by " +
                                  path_ + "/Level_0/Cell_H it has from -0.99"))
      << said[0];
  EXPECT_TRUE(
      said[0].ends_with("; the values are taken as they are, but one of the two files may be of another "
                        "plotfile: if so, copy it again"))
      << said[0];
  EXPECT_EQ(lines("Temp"), std::vector<std::string>{});
  set_first("Level_0/Cell_D_00001", std::nan(""));
  EXPECT_EQ(lines("density"), std::vector<std::string>{});
}

TEST_F(RangeCheck, RoundedRangesAndValues_AreNoneOutside) {
  for (const int version : {1, 3, 4}) {
    for (const bool single : {false, true}) {
      for (const int digits : {17, 5}) {
        PlotfilePlan plan = two_boxes();
        plan.version = version;
        plan.single = single;
        plan.big_endian = single;
        plan.range_digits = digits;
        test::write_plotfile(path_, plan);
        EXPECT_EQ(lines("density"), std::vector<std::string>{}) << version << single << digits;
        EXPECT_EQ(lines("Temp"), std::vector<std::string>{}) << version << single << digits;
      }
    }
  }
}

TEST_F(RangeCheck, GeneratedPlotfiles_HaveNoneOutside) {
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    path_ = scratch_.path("plt" + std::to_string(seed));
    PlotfilePlan plan = test::generated_plotfile(seed);
    plan.value = wave;
    test::write_plotfile(path_, plan);
    EXPECT_EQ(lines("x_velocity"), std::vector<std::string>{}) << seed;
  }
}

TEST_F(RangeCheck, SmallestDifferenceThatCounts_IsAHundredThousandthOfTheLargerBound) {
  PlotfilePlan plan = two_boxes();
  plan.value = [](std::size_t, std::size_t, const Index3&) { return 100.0; };
  for (const bool single : {false, true}) {
    plan.single = single;
    test::write_plotfile(path_, plan);
    const auto set = [&](double value) {
      if (single) return set_first("Level_0/Cell_D_00000", static_cast<float>(value));
      set_first("Level_0/Cell_D_00000", value);
    };
    set(100.0009);
    EXPECT_EQ(lines("density").size(), 0U);
    set(100.0011);
    EXPECT_EQ(lines("density").size(), 1U);
    set(99.9989);
    EXPECT_EQ(lines("density").size(), 1U);
  }
}

}  // namespace
}  // namespace weir::range_check_test
