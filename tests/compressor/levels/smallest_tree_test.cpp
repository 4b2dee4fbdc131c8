// Compares the size of the smallest tree, as it is known before a value is read, with the size that a conversion names.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "compressor/levels/smallest_tree.h"
#include "ingest/series.h"
#include "ingest/source_registry.h"
#include "tests/compressor/support/converted.h"
#include "tests/support/plotfile_writer.h"
#include "tests/support/temporary_directory.h"

namespace weir::smallest_tree_test {
namespace {

/// Returns a plotfile of two levels. The coarse level has two regions and more. Boxes of both levels end inside blocks.
test::PlotfilePlan two_levels() {
  test::PlotfilePlan plan;
  plan.domain = {{3, 0, 0}, {143, 40, 30}};
  plan.ratios = {{2, 2, 2}};
  plan.boxes = {{plan.domain}, {{{20, 10, 6}, {60, 30, 20}}, {{100, 10, 6}, {120, 32, 40}}}};
  return plan;
}

TEST(SmallestTree, OfLevels_IsThatWhichAConversionNames) {
  const TemporaryDirectory directory;
  const std::string path = directory / "plt";
  test::write_plotfile(path, two_levels());
  SourceOptions source;
  source.levels = Levels::separate;
  const std::vector<SeriesStep> steps = expand_series(std::vector{path}, source);
  ASSERT_EQ(steps.size(), 2U);
  for (const SeriesStep& step : steps) {
    SCOPED_TRACE(*step.level);
    const auto volume = open_source(path, options_of_step(source, step));
    for (const Encoding encoding :
         {Encoding::float32, Encoding::fpn, Encoding::fp4, Encoding::fp8, Encoding::fp16, Encoding::automatic}) {
      SCOPED_TRACE(encoding_name(encoding));
      ConversionOptions options;
      options.encoding = encoding;
      options.missing = MissingPolicy::background;
      EXPECT_EQ(smallest_tree(*volume, options), test::minimum_size(*volume, options));
    }
    for (const Preview preview : {Preview::off, Preview::on, Preview::automatic}) {
      SCOPED_TRACE(preview_name(preview));
      ConversionOptions packed;
      packed.encoding = Encoding::packed;
      packed.preview = preview;
      packed.missing = MissingPolicy::background;
      const std::uint64_t named = test::minimum_size(*volume, packed);
      EXPECT_LE(smallest_tree(*volume, packed), named);
      EXPECT_GE(smallest_tree(*volume, packed), named / 2);
      if (preview != Preview::on) {
        EXPECT_GE(room_for_packed(volume->info().domain()), named);
      }
    }
  }
}

TEST(SmallestTree, OfAVolumeWithoutGaps_HasItsFirstAndLastBlock) {
  test::MemoryVolume volume({{-3, 0, 0}, {140, 9, 9}}, [](const Index3& i) { return static_cast<float>(i.x); });
  for (const Encoding encoding : {Encoding::float32, Encoding::fpn}) {
    ConversionOptions options;
    options.encoding = encoding;
    EXPECT_EQ(smallest_tree(volume, options), test::minimum_size(volume, options));
  }
}

}  // namespace
}  // namespace weir::smallest_tree_test
