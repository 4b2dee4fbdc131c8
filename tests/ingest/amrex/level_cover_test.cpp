// Measures, by the kernel's figures, the peak memory that own_parts() takes to find a level's own cells. It must not
// exceed kBytesPerFinerBox for each box of finer levels.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "format/process/process_memory.h"
#include "ingest/amrex/level_cover.h"
#include "tests/support/child_answer.h"
#include "tests/support/sanitized.h"

namespace weir::level_cover_test {
namespace {

/// Returns two levels with the ratio 2. The coarse level is one box of `extent` cells. Boxes of 4^3 cells of the fine
/// level cover the coarse cells from z = `first` on.
std::vector<PlotfileLevel> two_levels(const Index3& extent, std::int64_t first) {
  std::vector<PlotfileLevel> levels(2);
  const auto cell = [](const Box& box) {
    const auto small = [](std::int64_t i) { return static_cast<std::int32_t>(i); };
    return CellBox{{small(box.lo.x), small(box.lo.y), small(box.lo.z)},
                   {small(box.hi.x - 1), small(box.hi.y - 1), small(box.hi.z - 1)}};
  };
  levels[0].extent = extent;
  levels[0].boxes = {cell({{0, 0, 0}, extent})};
  levels[1].extent = extent * 2;
  levels[1].ratio = {2, 2, 2};
  for_each_index({{0, 0, first / 2}, {extent.x / 2, extent.y / 2, extent.z / 2}}, [&](const Index3& i) {
    levels[1].boxes.push_back(cell({i * 4, (i + Index3{1, 1, 1}) * 4}));
  });
  for (PlotfileLevel& level : levels) {
    level.places.resize(level.boxes.size());
    level.index = BoxIndex(level.boxes);
  }
  return levels;
}

// Runs in a child process, so that the peak is that of this function alone.
std::string measure() {
  constexpr Index3 kExtent{128, 128, 128};
  const std::vector<PlotfileLevel> levels = two_levels(kExtent, 16);
  const std::uint64_t before = resident_bytes();
  const std::vector<CoverPart> parts = own_parts(levels, 0, 1, {{0, 0, 0}, kExtent});
  const std::uint64_t taken = peak_resident_bytes() - before;
  if (parts.size() != 1 || parts.front().box != Box{{0, 0, 0}, {128, 128, 16}}) return "not the level's own cells";
  const std::uint64_t most = levels[1].boxes.size() * kBytesPerFinerBox;
  if (taken > most) return "takes " + std::to_string(taken) + " bytes, planned " + std::to_string(most);
  return "ok " + std::to_string(taken);
}

TEST(LevelCover, UnderManyFinerBoxes_TakesWhatIsPlannedForThem) {
  if (kSanitized) GTEST_SKIP() << kSanitizedSkip;
  const std::string answer = answer_of_child(measure);
  EXPECT_TRUE(answer.starts_with("ok")) << answer;
  RecordProperty("taken", answer);
}

}  // namespace
}  // namespace weir::level_cover_test
