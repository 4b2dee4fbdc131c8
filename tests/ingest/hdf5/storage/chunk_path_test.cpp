// Reads a gzip-chunked dataset as a source. Each chunk is fetched as it is stored, once in a pass, and several threads
// decode the chunks.
#include <tbb/task_scheduler_observer.h>

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include "ingest/plan/block_plan.h"
#include "ingest/source_registry.h"
#include "tests/ingest/hdf5/support/chunked_file.h"
#include "tests/ingest/support/scratch.h"
#include "tests/support/sanitized.h"

namespace weir::chunk_path_test {
namespace {

std::vector<std::int32_t> field(std::size_t count) {
  std::vector<std::int32_t> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<std::int32_t>(i / 5 + i * i % 7);
  return values;
}

struct Chunked {
  std::string path;
  std::vector<float> values;
  std::uint64_t stored_bytes = 0;
};

Chunked write(const Scratch& scratch, const ChunkedShape& shape) {
  Chunked made{scratch.path("f.h5"), {}, 0};
  ChunkedFile file(made.path, shape);
  const std::vector<std::int32_t> values = field(file.elements());
  file.write(H5T_NATIVE_INT, values);
  made.values.assign(values.begin(), values.end());
  made.stored_bytes = H5Dget_storage_size(file.dataset());
  return made;
}

TEST(ChunkPath, GzipAndShuffleAreFetchedAsStoredAndOnceEach) {
  const Scratch scratch;
  const Chunked file =
      write(scratch, {{96, 100, 130}, {32, 32, 32}, {H5Z_FILTER_SHUFFLE, H5Z_FILTER_DEFLATE}, false, H5T_STD_I32BE});
  ASSERT_LT(file.stored_bytes, file.values.size() * 4 / 2);
  const auto source = open_source(file.path, {});
  const BlockPlan plan = plan_blocks(source->info().domain(), source->access(), std::uint64_t{2} << 20U);
  ASSERT_GT(plan.size(), 1);
  for (std::int64_t i = 0; i < plan.size(); ++i) {
    const Box box = plan.voxel_box(plan.leaf_box(i));
    std::vector<float> values(static_cast<std::size_t>(box.voxels()));
    source->read(box, values);
    for (std::size_t v = 0; v < values.size(); ++v) {
      const Index3 at = box.lo + index_at(static_cast<std::int64_t>(v), box.extent());
      ASSERT_EQ(values[v], file.values[static_cast<std::size_t>(linear_index(at, {130, 100, 96}))]);
    }
  }
  // If the library decoded the chunks, bytes_read() would count decoded bytes.
  EXPECT_EQ(source->bytes_read(), file.stored_bytes);
}

/// Counts the threads that take part in TBB's work.
class Observer : public tbb::task_scheduler_observer {
 public:
  Observer() { observe(true); }
  ~Observer() override { observe(false); }
  Observer(const Observer&) = delete;
  Observer& operator=(const Observer&) = delete;
  void on_scheduler_entry(bool) override { ++threads; }
  std::atomic<int> threads{0};
};

TEST(ChunkPath, GzipAndShuffleUseMoreThanOneThread) {
  if (std::thread::hardware_concurrency() < 2) GTEST_SKIP() << "one core";
  const Scratch scratch;
  const Chunked file =
      write(scratch, {{128, 256, 256}, {32, 64, 64}, {H5Z_FILTER_SHUFFLE, H5Z_FILTER_DEFLATE}, false, H5T_STD_I32LE});
  const auto source = open_source(file.path, {});
  std::vector<float> values(file.values.size());
  const LeaksOfLibraries of_tbb;
  const Observer observer;
  source->read(source->info().domain(), values);
  EXPECT_GT(observer.threads, 1);
  EXPECT_EQ(values, file.values);
}

}  // namespace
}  // namespace weir::chunk_path_test
