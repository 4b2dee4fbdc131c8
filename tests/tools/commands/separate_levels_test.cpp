// Tests weir convert --levels separate, which writes a file for each level of refinement, with the real command.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <filesystem>
#include <regex>
#include <string>
#include <thread>
#include <vector>

#include "format/leaf/leaf_decode.h"
#include "format/nanovdb/nvdb_file.h"
#include "format/sidecar/read_sidecar.h"
#include "format/sidecar/sidecar.h"
#include "tests/support/plotfile_writer.h"
#include "tests/support/run_command.h"

namespace weir::separate_levels_command_test {
namespace {

namespace fs = std::filesystem;

/// Returns the plan of three levels with refinement ratios of 2, 2, 2 and 4, 4, 2. Faces of boxes lie inside blocks.
test::PlotfilePlan three_levels() {
  test::PlotfilePlan plan;
  plan.domain = {{-3, 5, 0}, {17, 21, 19}};
  plan.ratios = {{2, 2, 2}, {4, 4, 2}};
  plan.boxes = {test::random_boxes(plan.domain, 9, 100, 3)};
  plan.boxes.push_back({{{-2, 14, 4}, {14, 30, 20}}, {{14, 14, 4}, {20, 22, 12}}});
  plan.boxes.push_back({{{4, 64, 16}, {28, 84, 30}}, {{28, 64, 16}, {48, 72, 22}}});
  plan.corner = {-1, 2, 0.5};
  plan.spacing = {0.5, 0.25, 1};
  return plan;
}

bool has(const std::vector<Box>& boxes, const Box& cells) {
  return std::any_of(boxes.begin(), boxes.end(), [&](const Box& box) { return box.contains(cells); });
}

class SeparateLevels : public testing::Test {
 protected:
  CommandResult convert(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"convert", path_, "--levels", "separate", "-o", directory_ / "out/"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_weir(arguments);
  }
  std::string out(std::size_t from_finest) const {
    return directory_ / ("out/plt00042_level_" + std::to_string(from_finest) + ".nvdb");
  }

  TemporaryDirectory directory_;
  std::string path_ = directory_ / "plt00042";
};

TEST_F(SeparateLevels, EachFileHasTheCellsThatNoFinerLevelHas_AndNoOtherIsActive) {
  const test::PlotfilePlan plan = three_levels();
  test::write_plotfile(path_, plan);
  const CommandResult made = convert({"--lossless", "--encoding", "float", "--background", "-1"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  for (std::size_t level = 0; level < plan.levels(); ++level) {
    SCOPED_TRACE(level);
    const std::string file = out(plan.levels() - 1 - level);
    const NvdbFile opened(file);
    const NvdbGrid& grid = opened.grid();
    const Index3 ratio = plan.ratio(0, level);
    const std::array<double, 3> cell{0.5 / static_cast<double>(ratio.x), 0.25 / static_cast<double>(ratio.y),
                                     1 / static_cast<double>(ratio.z)};
    EXPECT_EQ(grid.voxel_size(), cell);
    EXPECT_EQ(grid.world_origin(), (std::array<double, 3>{-1 + cell[0] / 2, 2 + cell[1] / 2, 0.5 + cell[2] / 2}));
    std::uint64_t own = 0;
    const Box domain = plan.domain_of(level);
    const Box& bounds = grid.index_bbox();
    for_each_index({{0, 0, 0}, domain.extent()}, [&](const Index3& i) {
      const Index3 at = domain.lo + i;
      bool mine = has(plan.boxes[level], {at, at + Index3{1, 1, 1}});
      for (std::size_t finer = level + 1; finer < plan.levels(); ++finer) {
        const Index3 r = plan.ratio(level, finer);
        const Index3 lo{at.x * r.x, at.y * r.y, at.z * r.z};
        mine = mine && !has(plan.boxes[finer], {lo, lo + r});
      }
      own += mine ? 1 : 0;
      const GridBlock block = grid.block_at(i);
      const Index3 inside = i - block.origin;
      const auto offset = static_cast<unsigned>(inside.x << 6 | inside.y << 3 | inside.z);
      const bool active = block.leaf != nullptr ? leaf_active(block.leaf, offset) : block.active;
      const bool pinned = i == bounds.lo || i == bounds.hi - Index3{1, 1, 1};
      ASSERT_EQ(active, mine || pinned) << i.x << ' ' << i.y << ' ' << i.z;
      ASSERT_EQ(grid.value(i), mine ? static_cast<float>(plan.value(level, 0, at)) : -1.0F);
    });
    const Sidecar sidecar = read_sidecar(sidecar_path(file));
    EXPECT_EQ(sidecar.missing.count, static_cast<std::uint64_t>(bounds.voxels()) - own);
    EXPECT_EQ(sidecar.missing.policy, "background");
    EXPECT_EQ(sidecar.source.level->number, static_cast<std::int64_t>(level));
    EXPECT_EQ(sidecar.source.level->count, 3);
    EXPECT_TRUE(sidecar.error.lossless);
    EXPECT_EQ(run_weir({"verify", file}).exit_code, 0);
    // Level and rule come from the sidecar.
    const CommandResult compared = run_weir({"compare", path_, file});
    EXPECT_EQ(compared.exit_code, 0) << compared.err;
    EXPECT_NE(compared.out.find("lossless"), std::string::npos) << compared.out;
  }
}

TEST_F(SeparateLevels, ASizeIsThatOfEachFile) {
  test::write_plotfile(path_, three_levels());
  const CommandResult made = convert({"--size", "600000"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  for (const std::size_t n : {0U, 1U, 2U}) EXPECT_EQ(fs::file_size(out(n)), 600'000U);
}

/// Converting a large finest level may take hours, so every level's budget is checked before the first conversion.
TEST_F(SeparateLevels, ARateBelowTheSmallestTreeOfOne_ConvertsNone_AndWhatTheErrorNamesSuitsAll) {
  test::PlotfilePlan plan;
  plan.domain = {{0, 0, 0}, {64, 64, 64}};
  plan.ratios = {{2, 2, 2}};
  plan.boxes = {{plan.domain}, {{{4, 4, 4}, {124, 124, 124}}}};
  plan.single = true;
  test::write_plotfile(path_, plan);
  const CommandResult refused = convert({"--rate", "8"});
  EXPECT_EQ(refused.exit_code, 4);
  EXPECT_FALSE(fs::exists(directory_.path() / "out"));
  std::smatch named;
  const std::regex wording(
      "weir: (.*): 131072 bytes asked, the smallest tree for this level takes ([0-9]+); nothing is converted; ask for "
      "--rate ([0-9.]+) or less, --size ([0-9]+) or more, or for --encoding packed\n");
  ASSERT_TRUE(std::regex_match(refused.err, named, wording)) << refused.err;
  EXPECT_EQ(named[1], out(1));
  EXPECT_GT(std::stoull(named[4]), std::stoull(named[2]));  // the smallest size that suits the finest level
  const CommandResult dry = convert({"--rate", "8", "--dry-run"});
  EXPECT_EQ(dry.exit_code, 4);
  EXPECT_EQ(dry.err, refused.err);
  for (const std::vector<std::string>& budget :
       {std::vector<std::string>{"--rate", named[3]}, std::vector<std::string>{"--size", named[4]},
        std::vector<std::string>{"--rate", "8", "--encoding", "packed"}}) {
    SCOPED_TRACE(budget.back());
    std::vector<std::string> arguments = budget;
    arguments.emplace_back("--overwrite");
    const CommandResult made = convert(arguments);
    EXPECT_EQ(made.exit_code, 0) << made.err;
  }
  EXPECT_EQ(fs::file_size(out(1)), 131'072U);
  const std::string less = std::to_string(std::stoull(named[4]) - 1);
  EXPECT_EQ(convert({"--size", less, "--overwrite"}).exit_code, 4);
}

TEST_F(SeparateLevels, KilledBetweenTwoLevels_LeavesWholeFilesAndTheNextRunMakesTheRest) {
  test::PlotfilePlan plan;
  plan.domain = {{0, 0, 0}, {96, 96, 96}};
  plan.ratios = {{2, 2, 2}};
  plan.boxes = {{plan.domain}, {{{0, 0, 0}, {16, 16, 16}}}};
  plan.single = true;
  test::write_plotfile(path_, plan);
  ASSERT_EQ(convert({"--lossless"}).exit_code, 0);
  const std::vector<std::string> expected{read_file(out(0)), read_file(out(1))};
  fs::remove_all(directory_.path() / "out");

  ChildProcess command({WEIR_COMMAND, "convert", path_, "--levels", "separate", "-o", directory_ / "out/", "--lossless",
                        "--bandwidth", "2MB"});
  while (command.running() && !fs::exists(sidecar_path(out(0)))) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(200));  // the second conversion is running
  command.send_signal(SIGKILL);
  EXPECT_EQ(command.wait().exit_code, 128 + SIGKILL);
  std::vector<std::string> visible = list_directory(directory_.path() / "out");
  std::erase_if(visible, [](const std::string& name) { return name.starts_with('.') || name.ends_with(".partial"); });
  EXPECT_EQ(visible, (std::vector<std::string>{"plt00042_level_0.nvdb", "plt00042_level_0.nvdb.json"}));
  EXPECT_EQ(read_file(out(0)), expected[0]);
  const auto before = fs::last_write_time(out(0));

  const CommandResult again = convert({"--lossless", "--skip-done"});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(fs::last_write_time(out(0)), before);
  EXPECT_EQ(read_file(out(0)), expected[0]);
  EXPECT_EQ(read_file(out(1)), expected[1]);
  EXPECT_EQ(list_directory(directory_.path() / "out").size(), 4U);
}

TEST_F(SeparateLevels, OtherFormatsAndCommandsOfOneVolumeRefuseThem) {
  test::write_plotfile(path_, three_levels());
  const CommandResult swept = run_weir({"sweep", path_, "--levels", "separate", "-o", directory_ / "s"});
  EXPECT_EQ(swept.exit_code, 2);
  EXPECT_EQ(swept.err, "weir: no option --levels; did you mean --level? see weir sweep --help\n");
  const std::string raw = directory_ / "v_2x2x2_uint8.raw";
  write_file(raw, "12345678");
  const CommandResult of_raw = run_weir({"convert", raw, "--levels", "separate"});
  EXPECT_EQ(of_raw.exit_code, 2);
  EXPECT_EQ(of_raw.err, "weir: " + raw + ": --levels separate is for AMReX plotfiles, and this is raw; leave it out\n");
}

}  // namespace
}  // namespace weir::separate_levels_command_test
