// The outlook for a budget, judged by a sample. The sample of a small volume is the whole volume.
#include "compressor/outlook/budget_outlook.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "compressor/packed/ladder_builder.h"
#include "compressor/select/selection.h"
#include "compressor/survey/survey.h"
#include "ingest/synthetic/synthetic.h"
#include "tests/compressor/support/crash_file_system.h"
#include "tests/compressor/support/memory_volume.h"
#include "tests/compressor/support/packed_files.h"

namespace weir::budget_outlook_test {
namespace {

using test::packed;

using Change = std::function<void(std::vector<float>&)>;

test::MemoryVolume make_volume(const char* kind, std::int64_t edge, const Change& change) {
  test::MemoryVolume volume(*open_synthetic(kind, {{edge, edge, edge}, 1}));
  if (!change) return volume;
  std::vector<float> values(volume.values().begin(), volume.values().end());
  change(values);
  return {volume.info().domain(), std::move(values)};
}

// A cube of `edge` voxels along each axis, surveyed for packed blocks without a preview.
class Cube {
 public:
  Cube(const char* kind, std::int64_t edge, const Change& change = {}) : volume_(make_volume(kind, edge, change)) {
    plan_ = plan_blocks(volume_.info().domain(), volume_.access(), std::uint64_t{1} << 30U);
    rows_ = std::make_unique<RowStore>(files_.create_unnamed("rows"), plan_.lattice, SelectionRoom{64, 0});
    rows_->set_ladders(std::make_unique<LeafStore<PackedLadder>>(files_.create_unnamed("ladders"), plan_.lattice));
    LadderAim aim;
    aim.near_rungs = true;
    aim.near = NearBlocks::all;
    survey_ = survey_volume(volume_, plan_, *rows_, {}, {.ladders = aim});
  }

  BudgetOutlook outlook(const Budget& budget) const {
    FileRequest request;
    request.budget = budget;
    request.domain = volume_.info().domain();
    request.packed.preview = Preview::off;
    return outlook_of(request, *rows_);
  }
  // Returns the cut of a file of the volume with 1 / rate of the dense bytes.
  std::optional<double> cut(double rate) const {
    GainRule rule;
    rule.encoding = Encoding::packed;
    rule.packed = PackedRule{false, coarsest_step(survey_.min, survey_.max)};
    TreeRegions tree(volume_.info().domain());
    Selection selection(rule, *rows_, tree, Selection::Search::no);
    selection.choose(static_cast<std::uint64_t>(static_cast<double>(4 * volume_.info().domain().voxels()) / rate));
    return selection.cut_key();
  }

 private:
  test::MemoryVolume volume_;
  BlockPlan plan_;
  test::CrashFileSystem files_;
  std::unique_ptr<RowStore> rows_;
  Survey survey_;
};

BudgetOutlook outlook_at(const char* kind, double psnr, std::int64_t edge) {
  return Cube(kind, edge).outlook(packed(Budget::Kind::psnr, psnr).budget);
}
NearBlocks bought_at(const char* kind, double psnr) { return outlook_at(kind, psnr, 96).near; }

TEST(BudgetOutlook, NearRungsOfASparseCloudAreForItsSparseBlocksUntilNearlyAllIsKept) {
  EXPECT_EQ(bought_at("cloud", 60), NearBlocks::sparse);
  EXPECT_EQ(bought_at("cloud", 130), NearBlocks::all);
}

TEST(BudgetOutlook, DenseTurbulenceHasThemWhereNearlyAllIsKeptAlone) {
  EXPECT_EQ(bought_at("turbulence", 60), NearBlocks::none);
  EXPECT_EQ(bought_at("turbulence", 140), NearBlocks::all);
}

// In 256^3 voxels all eight regions have values. Their preview takes 0.27 MB; a file has it only from ten times that
// on.
TEST(BudgetOutlook, FilesThatAreClearlyShorterThanTenPreviewsAreKnown) {
  EXPECT_TRUE(outlook_at("turbulence", 40, 256).short_of_preview);
  EXPECT_FALSE(outlook_at("turbulence", 100, 256).short_of_preview);
}

// All rows of a dense volume take about the same number of bytes. In a sparse volume few rows have any values.
TEST(BudgetOutlook, TheCutOfADenseVolumeLiesInANarrowWindow) {
  for (const char* kind : {"turbulence", "noise", "tiny", "denormal"}) {
    const Cube cube(kind, 256);
    for (const double rate : {8, 20, 50}) {
      const KeyWindow window = cube.outlook(packed(Budget::Kind::rate, rate).budget).window.value();
      EXPECT_LT(window.reach(), 1.6) << kind << ' ' << rate;
      EXPECT_TRUE(window.holds(cube.cut(rate).value())) << kind << ' ' << rate;
    }
  }
}

TEST(BudgetOutlook, TheCutOfASparseVolumeMayLieFarAway) {
  const Cube cube("cloud", 256);
  for (const double rate : {20, 50}) {
    const KeyWindow window = cube.outlook(packed(Budget::Kind::rate, rate).budget).window.value();
    EXPECT_EQ(window.reach(), KeyWindow::kMostReach) << rate;
    EXPECT_TRUE(window.holds(cube.cut(rate).value())) << rate;
  }
}

// The sample does not judge what blocks without finite values take.
TEST(BudgetOutlook, TheCutOfAVolumeWithMissingValuesMayLieFarAway) {
  const Cube cube("turbulence", 256, [](std::vector<float>& values) {
    std::fill_n(values.begin(), values.size() / 10, std::numeric_limits<float>::quiet_NaN());
  });
  EXPECT_EQ(cube.outlook(packed(Budget::Kind::rate, 20).budget).window.value().reach(), KeyWindow::kMostReach);
}

TEST(BudgetOutlook, TheCutOfAnErrorMayLieAsFarAway) {
  EXPECT_EQ(outlook_at("turbulence", 60, 256).window.value().reach(), KeyWindow::kMostReach);
}

TEST(BudgetOutlook, SparseBlocksAreThoseThatAreMostlyZero) {
  LeafRow row{};
  row.finite = 512;
  row.zeros = 257;
  LadderAim aim;
  aim.near_rungs = true;
  EXPECT_EQ(aim.near_for(row, false), NearRungs::no);
  EXPECT_EQ(aim.near_for(row, true), NearRungs::yes) << "sampled";
  aim.near = NearBlocks::sparse;
  EXPECT_EQ(aim.near_for(row, false), NearRungs::yes);
  row.zeros = 256;
  EXPECT_EQ(aim.near_for(row, false), NearRungs::no);
  aim.near = NearBlocks::all;
  EXPECT_EQ(aim.near_for(row, false), NearRungs::yes);
}

}  // namespace
}  // namespace weir::budget_outlook_test
