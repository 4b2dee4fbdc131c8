// Compares the levels of generated plotfiles, each a volume of its own, with a reference that looks at every box for
// every cell.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "ingest/series.h"
#include "ingest/series_names.h"
#include "ingest/source_registry.h"
#include "tests/ingest/support/scratch.h"
#include "tests/support/message_of_error.h"
#include "tests/support/plotfile_writer.h"

namespace weir::separate_levels_test {
namespace {

using test::PlotfilePlan;

bool has_all(const std::vector<Box>& boxes, const Box& cells) {
  return std::any_of(boxes.begin(), boxes.end(), [&](const Box& box) { return box.contains(cells); });
}

/// Returns whether `cell` is an own cell of `level`: a box of `level` has it, and no single box of a finer level up to
/// `finest` covers it whole. Indices count as in the file.
bool is_own(const PlotfilePlan& plan, std::size_t level, std::size_t finest, const Index3& cell) {
  if (!has_all(plan.boxes[level], {cell, cell + Index3{1, 1, 1}})) return false;
  for (std::size_t finer = level + 1; finer <= finest; ++finer) {
    const Index3 r = plan.ratio(level, finer);
    const Index3 lo{cell.x * r.x, cell.y * r.y, cell.z * r.z};
    if (has_all(plan.boxes[finer], {lo, lo + r})) return false;
  }
  return true;
}

Box bounds_of(const std::vector<Box>& boxes) {
  Box bounds = boxes.front();
  for (const Box& box : boxes) bounds = {min(bounds.lo, box.lo), max(bounds.hi, box.hi)};
  return bounds;
}

std::vector<std::uint32_t> expected_bits(const PlotfilePlan& plan, std::size_t level, std::size_t finest,
                                         const Box& box) {
  std::vector<std::uint32_t> bits;
  const Index3 first = plan.domain_of(level).lo;
  for_each_index(box, [&](const Index3& i) {
    const Index3 cell = first + i;
    const bool own = is_own(plan, level, finest, cell);
    bits.push_back(
        std::bit_cast<std::uint32_t>(own ? static_cast<float>(plan.value(level, 1, cell)) : missing_value()));
  });
  return bits;
}

std::vector<std::uint32_t> read_bits(VolumeSource& source, const Box& box) {
  std::vector<float> values(static_cast<std::size_t>(box.voxels()), -1.0F);
  source.read(box, values);
  std::vector<std::uint32_t> bits;
  for (const float v : values) bits.push_back(std::bit_cast<std::uint32_t>(v));
  return bits;
}

SourceOptions separate() {
  SourceOptions options;
  options.levels = Levels::separate;
  return options;
}

TEST(SeparateLevels, GeneratedPlotfiles_HaveTheCellsThatNoFinerLevelHas) {
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    SCOPED_TRACE(seed);
    const Scratch scratch;
    const PlotfilePlan plan = test::generated_plotfile(seed);
    const std::string path = scratch.path("plt00042");
    test::write_plotfile(path, plan);
    std::mt19937_64 random(seed);
    for (std::size_t finest = 0; finest < plan.levels(); ++finest) {
      SourceOptions options = separate();
      options.dataset = "x_velocity";
      options.level = static_cast<std::int64_t>(finest);
      const auto steps = expand_series(std::vector{path}, options);
      ASSERT_EQ(steps.size(), finest + 1);
      for (std::size_t n = 0; n < steps.size(); ++n) {
        const std::size_t level = finest - n;
        const auto source = open_source(steps[n].path, options_of_step(options, steps[n]));
        const SourceInfo& info = source->info();
        const Box boxes = bounds_of(plan.boxes[level]);
        const Index3 first = plan.domain_of(level).lo;
        ASSERT_EQ(info.domain(), (Box{boxes.lo - first, boxes.hi - first}));
        EXPECT_TRUE(info.mapping.gaps);
        ASSERT_EQ(read_bits(*source, info.domain()), expected_bits(plan, level, finest, info.domain()));
        for (int i = 0; i < 3; ++i) {
          Box box;
          const auto range = [&](std::int64_t from, std::int64_t end, std::int64_t& lo, std::int64_t& hi) {
            lo = from + static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(end - from));
            hi = lo + 1 + static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(end - lo));
          };
          range(info.domain().lo.x, info.domain().hi.x, box.lo.x, box.hi.x);
          range(info.domain().lo.y, info.domain().hi.y, box.lo.y, box.hi.y);
          range(info.domain().lo.z, info.domain().hi.z, box.lo.z, box.hi.z);
          ASSERT_EQ(read_bits(*source, box), expected_bits(plan, level, finest, box));
        }
      }
    }
  }
}

/// Returns the plan of two levels with the ratio `ratio`. Boxes are aligned to coarse cells, as AMReX makes them.
PlotfilePlan two_levels(const Index3& ratio) {
  PlotfilePlan plan;
  plan.components = {"density"};
  plan.ratios = {ratio};
  plan.corner = {-1, 0.5, 3};
  plan.spacing = {0.5, 0.25, 1};
  const auto fine = [&](const Index3& i) { return Index3{i.x * ratio.x, i.y * ratio.y, i.z * ratio.z}; };
  plan.boxes.push_back({{fine({3, 4, 5}), fine({9, 8, 13})}, {fine({9, 8, 5}), fine({11, 13, 7})}});
  return plan;
}

TEST(SeparateLevels, EachHasItsOwnSpacingAndOrigin) {
  for (const Index3& ratio : {Index3{2, 2, 2}, Index3{4, 4, 4}, Index3{4, 2, 1}}) {
    const Scratch scratch;
    const std::string path = scratch.path("plt");
    test::write_plotfile(path, two_levels(ratio));
    const auto steps = expand_series(std::vector{path}, separate());
    ASSERT_EQ(steps.size(), 2U);
    const auto fine = open_source(path, options_of_step(separate(), steps[0]));
    const std::array<double, 3> cell{0.5 / static_cast<double>(ratio.x), 0.25 / static_cast<double>(ratio.y),
                                     1 / static_cast<double>(ratio.z)};
    EXPECT_EQ(fine->info().spacing, cell);
    EXPECT_EQ(fine->info().origin, (std::array<double, 3>{-1 + cell[0] / 2, 0.5 + cell[1] / 2, 3 + cell[2] / 2}));
    EXPECT_EQ(fine->info().index_origin, (Index3{3 * ratio.x, 4 * ratio.y, 5 * ratio.z}));
    const auto coarse = open_source(path, options_of_step(separate(), steps[1]));
    EXPECT_EQ(coarse->info().spacing, (std::array<double, 3>{0.5, 0.25, 1}));
    EXPECT_EQ(coarse->info().origin, (std::array<double, 3>{-0.75, 0.625, 3.5}));
    EXPECT_EQ(coarse->info().domain(), (Box{{0, 0, 0}, {16, 16, 16}}));
    EXPECT_EQ(coarse->info().details.level->number, 0);
    EXPECT_EQ(coarse->info().details.level->count, 2);
  }
}

TEST(SeparateLevels, LossIsThatOfTheCellsThatAreTheLevelsOwn) {
  const Scratch scratch;
  PlotfilePlan plan = two_levels({2, 2, 2});
  plan.value = [](std::size_t, std::size_t, const Index3&) { return 0.1; };
  test::write_plotfile(scratch.path("plt"), plan);
  const auto steps = expand_series(std::vector{scratch.path("plt")}, separate());
  const auto coarse = open_source(scratch.path("plt"), options_of_step(separate(), steps[1]));
  std::vector<float> values(16 * 16 * 16);
  EXPECT_EQ(coarse->read(coarse->info().domain(), values).inexact, 4096U - (6 * 4 * 8) - (2 * 5 * 2));
}

TEST(SeparateLevels, NamesCountFromTheFinest) {
  const Scratch scratch;
  PlotfilePlan plan = two_levels({2, 2, 2});
  plan.components = {"density", "Temp"};
  const std::string path = scratch.path("plt00042");
  test::write_plotfile(path, plan);
  SourceOptions options = separate();
  options.dataset = "Temp";
  const auto names = [&](const std::string& output, DefaultNames kind = DefaultNames::of_file) {
    return series_outputs(expand_series(std::vector{path}, options), output, options, kind);
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(names(""), (Names{path + "_Temp_level_0.nvdb", path + "_Temp_level_1.nvdb"}));
  EXPECT_EQ(names("t.nvdb"), (Names{"t_level_0.nvdb", "t_level_1.nvdb"}));
  EXPECT_EQ(names("o/", DefaultNames::of_call), (Names{"o/plt00042_level_0.nvdb", "o/plt00042_level_1.nvdb"}));
  options.level = 0;
  EXPECT_EQ(names(""), Names{path + "_Temp_level0_level_0.nvdb"});
}

TEST(SeparateLevels, OneVolumeIsAskedForWhereThereAreSeveral) {
  const Scratch scratch;
  const std::string path = scratch.path("plt");
  test::write_plotfile(path, two_levels({2, 2, 2}));
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { open_source(path, separate()); }),
            path + ": --levels separate stands for 2 volumes, and one is read here; leave it out");
  SourceOptions coarsest = separate();
  coarsest.level = 0;
  EXPECT_EQ(open_source(path, coarsest)->info().details.level->count, 1);
  SourceOptions upsampled = separate();
  upsampled.upsampling = Upsampling::linear;
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { open_source(path, upsampled); }),
            path + ": --upsample is for --levels composite; with separate levels leave it out");
}

}  // namespace
}  // namespace weir::separate_levels_test
