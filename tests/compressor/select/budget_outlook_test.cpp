// What a budget will buy, judged by a sample, which is all of the small volumes.
#include "compressor/select/budget_outlook.h"

#include <gtest/gtest.h>

#include <memory>

#include "compressor/packed/ladder_builder.h"
#include "compressor/survey/survey.h"
#include "ingest/synthetic/synthetic.h"
#include "tests/compressor/support/crash_file_system.h"
#include "tests/compressor/support/memory_volume.h"

namespace weir::budget_outlook_test {
namespace {

BudgetOutlook outlook_of_cube(const char* kind, std::int64_t edge, const Budget& budget) {
  const auto source = open_synthetic(kind, {{edge, edge, edge}, 1});
  test::MemoryVolume volume(*source);
  const BlockPlan plan = plan_blocks(volume.info().domain(), volume.access(), std::uint64_t{1} << 30U);
  test::CrashFileSystem files;
  RowStore rows(files.create_unnamed("rows"), plan.lattice, {64, 0});
  rows.set_ladders(std::make_unique<LeafStore<PackedLadder>>(files.create_unnamed("ladders"), plan.lattice));
  LadderAim aim;
  aim.near_rungs = true;
  survey_volume(volume, plan, rows, {}, {.ladders = aim});
  FileRequest request;
  request.budget = budget;
  request.domain = volume.info().domain();
  return outlook_of(request, rows);
}

BudgetOutlook outlook_at(const char* kind, double psnr, std::int64_t edge) {
  Budget budget;
  budget.kind = Budget::Kind::psnr;
  budget.target = psnr;
  return outlook_of_cube(kind, edge, budget);
}

// How far from the window's centre the cut at that part of the dense bytes may lie.
double reach_at(const char* kind, double rate) {
  Budget budget;
  budget.kind = Budget::Kind::rate;
  budget.rate = rate;
  return outlook_of_cube(kind, 256, budget).window.value().reach();
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

// Of 256^3 voxels all eight regions have something: their preview takes 0.27 MB, ten times that is the least of a file.
TEST(BudgetOutlook, FilesThatAreClearlyShorterThanTenPreviewsAreKnown) {
  EXPECT_TRUE(outlook_at("turbulence", 40, 256).short_of_preview);
  EXPECT_FALSE(outlook_at("turbulence", 100, 256).short_of_preview);
}

// Rows of a dense volume take about as many bytes each; few rows of a sparse one have anything.
TEST(BudgetOutlook, TheCutOfADenseVolumeIsKnownMoreCloselyThanThatOfASparseOne) {
  EXPECT_LT(reach_at("turbulence", 20), 1.5);
  EXPECT_EQ(reach_at("noise", 20), 1.25);
  EXPECT_EQ(reach_at("cloud", 20), KeyWindow::kMostReach);
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
