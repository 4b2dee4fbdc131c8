// Compares the composited grid of generated plotfiles with a reference that looks at every box for every cell.
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "ingest/source_registry.h"
#include "tests/ingest/support/scratch.h"
#include "tests/support/plotfile_writer.h"

namespace weir::composite_test {
namespace {

using test::PlotfilePlan;

std::vector<float> expected_values(const PlotfilePlan& plan, std::size_t component, std::size_t level, const Box& box) {
  std::vector<float> values;
  const Index3 lo = plan.domain_of(level).lo;
  for_each_index(box, [&](const Index3& i) {
    values.push_back(static_cast<float>(test::composite_value(plan, component, level, lo + i)));
  });
  return values;
}

std::vector<float> read_box(VolumeSource& source, const Box& box) {
  std::vector<float> values(static_cast<std::size_t>(box.voxels()), -1.0F);
  source.read(box, values);
  return values;
}

TEST(AmrexComposite, GeneratedPlotfiles_HaveTheValueOfTheFinestLevelInEachCell) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    const Scratch scratch;
    const PlotfilePlan plan = test::generated_plotfile(seed);
    const std::string path = scratch.path("plt00042");
    test::write_plotfile(path, plan);
    std::mt19937_64 random(seed);
    for (std::size_t level = 0; level < plan.levels(); ++level) {
      const std::size_t component = random() % 3;
      SourceOptions options;
      options.dataset = plan.components[component];
      options.level = static_cast<std::int64_t>(level);
      const auto source = open_source(path, options);
      ASSERT_EQ(source->info().extent, plan.domain_of(level).extent());
      const Box domain = source->info().domain();
      ASSERT_EQ(read_box(*source, domain), expected_values(plan, component, level, domain));
      for (int i = 0; i < 5; ++i) {
        Box box;
        const auto range = [&](std::int64_t extent, std::int64_t& lo, std::int64_t& hi) {
          lo = static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(extent));
          hi = lo + 1 + static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(extent - lo));
        };
        range(domain.hi.x, box.lo.x, box.hi.x);
        range(domain.hi.y, box.lo.y, box.hi.y);
        range(domain.hi.z, box.lo.z, box.hi.z);
        ASSERT_EQ(read_box(*source, box), expected_values(plan, component, level, box));
      }
    }
  }
}

TEST(AmrexComposite, DomainThatBeginsBelowZero_CountsFromItsLowerCorner) {
  const Scratch scratch;
  PlotfilePlan plan;
  plan.domain = {{-5, -4, -2}, {3, 4, 6}};
  plan.boxes = {{plan.domain}};
  const std::string path = scratch.path("plt00042");
  test::write_plotfile(path, plan);
  SourceOptions options;
  options.roi = VolumeRegion(Box{{-3, 0, 0}, {8, 1, 1}});
  const auto region = [&] {
    const auto source = open_source(path, options);
    return expected_values(plan, 0, 0, source->info().domain()) == read_box(*source, source->info().domain())
               ? source->info().domain()
               : Box{};
  };
  EXPECT_EQ(region(), (Box{{5, 0, 0}, {8, 1, 1}})) << "-3 is the third last";
  options.roi = VolumeRegion(Box{{1, 2, 3}, {3, 4, 5}});
  EXPECT_EQ(region(), (Box{{1, 2, 3}, {3, 4, 5}}));
}

bool covers_leaves(const RepeatedPart& part, const Box& box) {
  const auto on_leaf = [](std::int64_t at, std::int64_t end) { return at % kLeafDim == 0 || at == end; };
  return on_leaf(part.box.lo.x, box.lo.x) && on_leaf(part.box.hi.x, box.hi.x) && on_leaf(part.box.lo.y, box.lo.y) &&
         on_leaf(part.box.hi.y, box.hi.y) && on_leaf(part.box.lo.z, box.lo.z) && on_leaf(part.box.hi.z, box.hi.z);
}

/// Reads `box` part by part with read_repeated(). Adds the voxels of the parts that repeat values to `repeated`.
std::vector<float> read_parts(VolumeSource& source, const Box& box, ConversionLoss& loss, std::int64_t& repeated) {
  std::vector<float> values(static_cast<std::size_t>(box.voxels()), -1.0F);
  std::int64_t voxels = 0;
  for (const RepeatedPart& part : source.repeated_parts(box)) {
    EXPECT_TRUE(box.contains(part.box) && covers_leaves(part, box));
    EXPECT_EQ(part.groups().x * part.by.x, part.box.extent().x);
    EXPECT_EQ(part.values() * volume(part.by), part.box.voxels());
    voxels += part.box.voxels();
    repeated += part.repeats() ? part.box.voxels() : 0;
    std::vector<float> of_part(static_cast<std::size_t>(part.values()));
    loss.add(source.read_repeated(part, of_part));
    for_each_index(part.box, [&](const Index3& i) {
      const Index3 at = i - part.box.lo;
      const Index3 group{at.x / part.by.x, at.y / part.by.y, at.z / part.by.z};
      float& value = values[static_cast<std::size_t>(linear_index(i - box.lo, box.extent()))];
      EXPECT_EQ(value, -1.0F);  // parts share no voxel
      value = of_part[static_cast<std::size_t>(linear_index(group, part.groups()))];
    });
  }
  EXPECT_EQ(voxels, box.voxels());
  return values;
}

TEST(AmrexComposite, RepeatedParts_HaveTheValuesOfAllVoxels) {
  std::int64_t repeated = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    const Scratch scratch;
    PlotfilePlan plan = test::generated_plotfile(seed);
    plan.value = [](std::size_t level, std::size_t component, const Index3& cell) {
      return 0.1 + test::plain_plotfile_value(level, component, cell);
    };
    const std::string path = scratch.path("plt00042");
    test::write_plotfile(path, plan);
    SourceOptions options;
    options.dataset = "Temp";
    const auto source = open_source(path, options);
    const Box domain = source->info().domain();
    const Box inner{{domain.hi.x / 3, domain.hi.y / 4, 0}, {domain.hi.x, domain.hi.y / 2 + 1, domain.hi.z}};
    for (const Box& box : {domain, inner}) {
      std::vector<float> expected(static_cast<std::size_t>(box.voxels()));
      const ConversionLoss expected_loss = source->read(box, expected);
      ConversionLoss loss;
      ASSERT_EQ(read_parts(*source, box, loss, repeated), expected);
      EXPECT_EQ(loss.inexact, expected_loss.inexact);
      EXPECT_EQ(loss.max_abs_error, expected_loss.max_abs_error);
    }
  }
  EXPECT_GT(repeated, 100'000);
}

TEST(AmrexComposite, LinearValues_RepeatNothing) {
  const Scratch scratch;
  const std::string path = scratch.path("plt00042");
  test::write_plotfile(path, test::generated_plotfile(3));
  SourceOptions options;
  options.dataset = "Temp";
  options.upsampling = Upsampling::linear;
  const auto source = open_source(path, options);
  const std::vector<RepeatedPart> parts = source->repeated_parts(source->info().domain());
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_EQ(parts[0].box, source->info().domain());
  EXPECT_FALSE(parts[0].repeats());
}

/// Computes the composite of linear values from its definition, level by level. All sums are exact if the values are
/// whole numbers and the ratios are 1, 2 or 4.
class LinearOracle {
 public:
  LinearOracle(const PlotfilePlan& plan, std::size_t component) : plan_(plan), component_(component) {
    for (std::size_t l = 0; l < plan.levels(); ++l) grids_.push_back(grid_of(l));
  }
  const std::vector<float>& values(std::size_t level) const { return grids_[level]; }

 private:
  std::vector<float> grid_of(std::size_t level) {
    std::vector<float> grid;
    const Box domain = plan_.domain_of(level);
    const Box from_zero{{0, 0, 0}, domain.extent()};
    for_each_index(from_zero, [&](const Index3& i) {
      const Index3 cell = domain.lo + i;
      const auto has = [&](const Box& box) { return box.contains(cell); };
      const std::vector<Box>& boxes = plan_.boxes[level];
      grid.push_back(std::any_of(boxes.begin(), boxes.end(), has)
                         ? static_cast<float>(plan_.value(level, component_, cell))
                         : interpolated(level, i));
    });
    return grid;
  }

  float interpolated(std::size_t level, const Index3& i) const {
    const Index3 by = plan_.ratio(level - 1, level);
    const Index3 e = plan_.domain_of(level - 1).extent();
    const std::array<double, 3> at{position(i.x, by.x), position(i.y, by.y), position(i.z, by.z)};
    double sum = 0;
    for (std::int64_t corner = 0; corner < 8; ++corner) {
      const Index3 side{corner % 2, corner / 2 % 2, corner / 4};
      const auto weight = [](double p, std::int64_t s) {
        const double second = p - std::floor(p);
        return s == 1 ? second : 1 - second;
      };
      const auto cell = [](double p, std::int64_t s, std::int64_t extent) {
        return std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(p)) + s, 0, extent - 1);
      };
      const Index3 c{cell(at[0], side.x, e.x), cell(at[1], side.y, e.y), cell(at[2], side.z, e.z)};
      sum += weight(at[0], side.x) * weight(at[1], side.y) * weight(at[2], side.z) *
             static_cast<double>(grids_[level - 1][static_cast<std::size_t>(linear_index(c, e))]);
    }
    return static_cast<float>(sum);
  }

  static double position(std::int64_t i, std::int64_t by) {
    return (static_cast<double>(i) + 0.5) / static_cast<double>(by) - 0.5;
  }

  const PlotfilePlan& plan_;
  std::size_t component_;
  std::vector<std::vector<float>> grids_;
};

TEST(AmrexComposite, LinearValues_AreTrilinearBetweenTheCentresOfCoarseCells) {
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    SCOPED_TRACE(seed);
    const Scratch scratch;
    PlotfilePlan plan = test::generated_plotfile(seed);
    for (std::size_t i = 0; i < plan.ratios.size(); ++i) {
      if (plan.ratios[i].x != 3) continue;
      plan.ratios.resize(i);  // sums of thirds are not exact
      plan.boxes.resize(i + 1);
      break;
    }
    plan.value = [](std::size_t level, std::size_t component, const Index3& cell) {
      return static_cast<double>((cell.x * 7 + cell.y * 13 + cell.z * 29 + static_cast<std::int64_t>(level)) % 61) +
             static_cast<double>(component);
    };
    const std::string path = scratch.path("plt00042");
    test::write_plotfile(path, plan);
    const LinearOracle oracle(plan, 1);
    for (std::size_t level = 0; level < plan.levels(); ++level) {
      SourceOptions options;
      options.dataset = "x_velocity";
      options.upsampling = Upsampling::linear;
      options.level = static_cast<std::int64_t>(level);
      const auto source = open_source(path, options);
      const Box domain = source->info().domain();
      ASSERT_EQ(read_box(*source, domain), oracle.values(level));
      const Box inner{domain.hi - Index3{1, 2, 2}, domain.hi};
      std::vector<float> expected;
      for_each_index(inner, [&](const Index3& i) {
        expected.push_back(oracle.values(level)[static_cast<std::size_t>(linear_index(i, domain.hi))]);
      });
      ASSERT_EQ(read_box(*source, inner), expected);
    }
  }
}

TEST(AmrexComposite, LinearBesideAValueThatIsNotFinite_TakesTheCellsOwn) {
  const Scratch scratch;
  PlotfilePlan plan;
  plan.domain = {{0, 0, 0}, {4, 1, 1}};
  plan.ratios = {{2, 1, 1}};
  plan.boxes = {{plan.domain}, {{{0, 0, 0}, {1, 1, 1}}}};
  plan.value = [](std::size_t level, std::size_t, const Index3& cell) {
    return level == 0 && cell.x == 1 ? std::numeric_limits<double>::quiet_NaN() : static_cast<double>(10 * cell.x + 1);
  };
  test::write_plotfile(scratch.path("plt"), plan);
  SourceOptions options;
  options.upsampling = Upsampling::linear;
  const auto source = open_source(scratch.path("plt"), options);
  const std::vector<float> values = read_box(*source, source->info().domain());
  EXPECT_EQ(values[0], 1.0F);  // a cell of level 1
  EXPECT_EQ(values[1], 1.0F);
  EXPECT_TRUE(std::isnan(values[2]) && std::isnan(values[3]));
  EXPECT_EQ(values[4], 21.0F);
  EXPECT_EQ((std::vector<float>{values[5], values[6], values[7]}), (std::vector<float>{23.5F, 28.5F, 31.0F}));
}

/// Returns the plan of three levels along x. Some cells of each level have the value 7, and the other values differ, so
/// that linear upsampling interpolates between them.
PlotfilePlan plan_with_sevens() {
  PlotfilePlan plan;
  plan.domain = {{0, 0, 0}, {6, 2, 2}};
  plan.ratios = {{2, 2, 2}, {2, 2, 2}};
  plan.boxes = {{plan.domain}, {{{2, 0, 0}, {8, 4, 4}}}, {{{6, 0, 0}, {9, 3, 3}}}};
  plan.value = [](std::size_t level, std::size_t, const Index3& cell) {
    return cell.x % 4 == 0 ? 7 : 10 * static_cast<double>(cell.x + cell.y) + static_cast<double>(level);
  };
  return plan;
}

TEST(AmrexComposite, LinearBesideValuesOfNoDataThatAreKept_TakesTheCellsOwn) {
  const Scratch scratch;
  const std::string path = scratch.path("plt");
  for (const bool single : {false, true}) {
    PlotfilePlan plan = plan_with_sevens();
    plan.single = single;
    test::write_plotfile(path, plan);
    SourceOptions options;
    options.missing = StoredValue{std::int64_t{7}};
    options.upsampling = Upsampling::linear;
    const auto marked = open_source(path, options);
    options.keeps_missing = true;
    const auto kept = open_source(path, options);
    options.upsampling = Upsampling::constant;
    const auto constant = open_source(path, options);
    const Box domain = kept->info().domain();
    std::vector<float> expected = read_box(*marked, domain);
    const auto count = static_cast<std::uint64_t>(std::count_if(expected.begin(), expected.end(), is_missing));
    std::replace_if(expected.begin(), expected.end(), is_missing, 7.0F);
    std::vector<float> values(expected.size());
    const ConversionLoss loss = kept->read(domain, values);
    EXPECT_EQ(values, expected);
    EXPECT_EQ(loss.unmarked, count);
    EXPECT_GT(count, 100U);
    EXPECT_EQ(constant->read(domain, values).unmarked, count);
  }
}

TEST(AmrexComposite, LinearValuesWithoutOnesOfNoData_AreTheSameWhereTheseAreKept) {
  const Scratch scratch;
  test::write_plotfile(scratch.path("plt"), plan_with_sevens());
  SourceOptions options;
  options.upsampling = Upsampling::linear;
  const auto plain = open_source(scratch.path("plt"), options);
  options.keeps_missing = true;
  options.missing = StoredValue{-1.0};
  const auto kept = open_source(scratch.path("plt"), options);
  const Box domain = kept->info().domain();
  std::vector<float> values(static_cast<std::size_t>(domain.voxels()));
  EXPECT_EQ(kept->read(domain, values).unmarked, 0U);
  EXPECT_EQ(values, read_box(*plain, domain));
}

TEST(AmrexComposite, LossIsCountedOfTheVoxelsThatAreWritten) {
  const Scratch scratch;
  PlotfilePlan plan;
  plan.domain = {{0, 0, 0}, {4, 4, 4}};
  plan.ratios = {{2, 2, 2}};
  plan.boxes = {{plan.domain}, {{{1, 0, 0}, {3, 2, 2}}}};  // the box begins in the middle of a coarse cell
  plan.value = [](std::size_t, std::size_t, const Index3& cell) { return static_cast<double>(cell.x) + 0.1; };
  test::write_plotfile(scratch.path("plt"), plan);
  const auto source = open_source(scratch.path("plt"), {});
  const Box domain = source->info().domain();
  std::vector<float> values(static_cast<std::size_t>(domain.voxels()));
  EXPECT_EQ(source->read(domain, values).inexact, 512U);
  std::uint64_t in_parts = 0;
  for (std::int64_t x = 0; x < 8; ++x) {
    const Box slice{{x, 0, 0}, {x + 1, 8, 8}};
    in_parts += source->read(slice, std::span(values).first(64)).inexact;
  }
  EXPECT_EQ(in_parts, 512U);
}

TEST(AmrexComposite, BoxesLargerThanAPiece_AreReadInParts) {
  const Scratch scratch;
  for (const Index3& extent : {Index3{150'000, 2, 2}, Index3{700, 400, 3}, Index3{2, 3, 70'000}}) {
    PlotfilePlan plan;
    plan.components = {"a", "b"};
    plan.domain = {{0, 0, 0}, extent};
    plan.boxes = {{plan.domain}};
    const std::string path = scratch.path("plt" + std::to_string(extent.z));
    test::write_plotfile(path, plan);
    SourceOptions options;
    options.dataset = "b";
    const auto source = open_source(path, options);
    ASSERT_EQ(read_box(*source, plan.domain), expected_values(plan, 1, 0, plan.domain));
    const Box part{{extent.x / 3, 1, 1}, {extent.x - 1, 2, extent.z}};
    if (!part.empty()) {
      ASSERT_EQ(read_box(*source, part), expected_values(plan, 1, 0, part));
    }
  }
}

}  // namespace
}  // namespace weir::composite_test
