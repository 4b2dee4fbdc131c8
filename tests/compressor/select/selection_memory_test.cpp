// Selection over a row file sixteen times as large as the memory ceiling. The rows of an 8 GiB volume would fit in
// memory and prove nothing.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <vector>

#include "compressor/plan/memory_plan.h"
#include "compressor/select/selection.h"
#include "compressor/select/tree_plan.h"
#include "format/io/file_system.h"
#include "format/process/process_memory.h"
#include "tests/support/child_answer.h"
#include "tests/support/sanitized.h"

namespace weir::selection_memory_test {
namespace {

constexpr std::uint64_t kMemory = std::uint64_t{64} << 20U;
constexpr std::size_t kThreads = 2;

// Fills the rows of a volume in which leaves are worth different amounts. They are cheap to make.
void fill_rows(RowStore& store) {
  std::vector<LeafRow> rows(8192);
  const std::int64_t total = store.leaves().size();
  for (std::int64_t first = 0; first < total; first += static_cast<std::int64_t>(rows.size())) {
    const auto count =
        static_cast<std::size_t>(std::min<std::int64_t>(static_cast<std::int64_t>(rows.size()), total - first));
    for (std::size_t i = 0; i < count; ++i) {
      const auto hash = static_cast<std::uint32_t>((static_cast<std::uint64_t>(first) + i) * 2654435761U);
      LeafRow& row = rows[i];
      row.finite = 512;
      row.mean = static_cast<float>(hash % 1000);
      row.min = row.mean - 1;
      row.max = row.mean + 1;
      row.sse = static_cast<double>(hash >> 8U);
    }
    store.write(first, std::span(rows).first(count));
  }
}

// Runs in a child process, so that its peak memory is its own. Returns the text that the child prints on the pipe.
std::string measure() {
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, kThreads);
  const Box domain{{0, 0, 0}, {2304, 2304, 2176}};
  const auto files = make_posix_file_system();
  const MemoryPlan memory = plan_memory(kMemory, resident_bytes(), kThreads, domain);
  TreeRegions tree(domain);
  RowStore rows(files->create_unnamed(::testing::TempDir()), tree.leaves, memory.selection);
  const auto row_bytes = static_cast<std::uint64_t>(tree.leaves.size()) * sizeof(LeafRow);
  if (row_bytes < 16 * kMemory) return "the row file is too small";
  fill_rows(rows);
  Selection selection(GainRule{}, rows, tree);
  const std::uint64_t asked = selection.bytes().full.file_bytes / 8;
  selection.choose(asked);
  ChoiceStore masks(files->create_unnamed(::testing::TempDir()), tree.region_lattice.size());
  const TreePlan plan = plan_tree(selection, rows, tree, masks);
  if (plan.layout.file_bytes > asked || asked - plan.layout.file_bytes >= 33856 + 2144)
    return "the budget is not used up";
  const std::uint64_t peak = peak_resident_bytes();
  if (peak >= kMemory) return "peak RSS is " + std::to_string(peak) + " bytes";
  return "ok";
}

TEST(SelectionMemory, StaysUnderTheCeilingWithRowsSixteenTimesAsLarge) {
  if (kSanitized) GTEST_SKIP() << kSanitizedSkip;
  const std::string answer = answer_of_child([&] { return measure(); });
  EXPECT_EQ(answer, "ok");
}

}  // namespace
}  // namespace weir::selection_memory_test
