// The bytes of a packed file with a preview, as far as they are known before the file is planned.
#include <gtest/gtest.h>

#include <memory>
#include <optional>

#include "compressor/packed/ladder_builder.h"
#include "compressor/packed/packed_rule.h"
#include "compressor/select/selection.h"
#include "compressor/select/tree_plan.h"
#include "compressor/survey/survey.h"
#include "ingest/synthetic/synthetic.h"
#include "tests/compressor/support/crash_file_system.h"
#include "tests/compressor/support/memory_volume.h"

namespace weir::previewed_bytes_test {
namespace {

// Turbulence of 256 x 128 x 128 voxels, two regions, surveyed for packed blocks.
class PreviewedBytes : public testing::Test {
 protected:
  PreviewedBytes()
      : volume_(*open_synthetic("turbulence", {{256, 128, 128}, 1})),
        plan_(plan_blocks(volume_.info().domain(), volume_.access(), std::uint64_t{1} << 30U)),
        tree_(volume_.info().domain()) {}

  // Holds steps in up to `step_bytes`. If `about` is given, holds only the steps of a window about it.
  Selection select(Selection::Search search, std::uint64_t step_bytes, std::optional<double> about = std::nullopt) {
    rows_ = std::make_unique<RowStore>(files_.create_unnamed("rows"), plan_.lattice, SelectionRoom{64, step_bytes});
    rows_->set_ladders(std::make_unique<LeafStore<PackedLadder>>(files_.create_unnamed("ladders"), plan_.lattice));
    const Survey survey = survey_volume(volume_, plan_, *rows_, {}, {.ladders = LadderAim{}});
    GainRule rule;
    rule.encoding = Encoding::packed;
    rule.packed = PackedRule{true, coarsest_step(survey.min, survey.max)};
    if (about) {
      const float range = survey.max - survey.min;
      rule.packed->window = KeyWindow::about(*about, range);
      rule.packed->most_error = static_cast<double>(range * range) * 256 * 128 * 128;
    }
    return Selection(rule, *rows_, tree_, search);
  }
  TreeLayout layout_of(const Selection& selection) {
    const auto regions = static_cast<std::int64_t>(tree_.regions.size());
    ChoiceStore choices(files_.create_unnamed("choices"), regions);
    PlannedStreamsStore streams(files_.create_unnamed("streams"), regions);
    return plan_tree(selection, *rows_, tree_, choices, &streams).layout;
  }

  test::MemoryVolume volume_;
  BlockPlan plan_;
  TreeRegions tree_;
  test::CrashFileSystem files_;
  std::unique_ptr<RowStore> rows_;
};

constexpr std::uint64_t kEnough = std::uint64_t{64} << 20U;

TEST_F(PreviewedBytes, OfAnErrorAreNeverLessThanThoseOfTheFile) {
  for (const double error : {1e5, 1e4, 1e3, 1e1, 1e-3}) {
    Selection selection = select(Selection::Search::of_error, kEnough);
    selection.choose_error(error);
    const auto bytes = selection.previewed_bytes();
    ASSERT_TRUE(bytes) << error;
    const TreeLayout layout = layout_of(selection);
    const std::uint64_t regions = layout.counts.lowers;
    EXPECT_GE(bytes->most_of_file, layout.file_bytes) << error;
    EXPECT_LE(bytes->most_of_file, layout.file_bytes + regions * kChunkCost + 64) << error;
    EXPECT_EQ(bytes->preview, layout.node_bytes()) << error;
  }
}

TEST_F(PreviewedBytes, AreKnownWhereTheStepsOfAWindowAreHeld) {
  for (const double error : {1e4, 1e3, 1e1}) {
    Selection all = select(Selection::Search::of_error, kEnough);
    all.choose_error(error);
    ASSERT_TRUE(all.cut_key()) << error;
    const double about = *all.cut_key() * 1.5;
    Selection walked = select(Selection::Search::no, 0, about);
    walked.choose_error(error);
    EXPECT_FALSE(walked.previewed_bytes()) << error;
    const std::optional<double> cut = walked.cut_key();
    Selection held = select(Selection::Search::of_error, kEnough, about);
    held.choose_error(error);
    EXPECT_EQ(held.cut_key(), cut) << error;
    const auto bytes = held.previewed_bytes();
    ASSERT_TRUE(bytes) << error;
    const TreeLayout layout = layout_of(held);
    EXPECT_GE(bytes->most_of_file, layout.file_bytes) << error;
    EXPECT_LE(bytes->most_of_file, layout.file_bytes + layout.counts.lowers * kChunkCost + 64) << error;
  }
}

TEST_F(PreviewedBytes, ChosenBySize_AreThatSize) {
  Selection selection = select(Selection::Search::of_bytes, kEnough);
  selection.choose(400000);
  const auto bytes = selection.previewed_bytes();
  ASSERT_TRUE(bytes);
  EXPECT_EQ(bytes->most_of_file, 400000U);
  EXPECT_EQ(bytes->preview, layout_of(selection).node_bytes());
}

TEST_F(PreviewedBytes, OfAnErrorAreUnknownWhereNoStepsAreHeld) {
  Selection selection = select(Selection::Search::of_error, 0);
  selection.choose_error(1e3);
  EXPECT_FALSE(selection.previewed_bytes());
}

}  // namespace
}  // namespace weir::previewed_bytes_test
