// Tests how much memory the scratch for decoding chunks takes, and that its pool is bounded.
#include "ingest/chunks/chunk_scratch.h"

#include <atomic>
#include <thread>

#include "ingest/hdf5/filters/filter_pipeline.h"
#include "tests/ingest/support/scratch.h"

namespace weir::chunk_scratch_test {
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20U;
const FilterPipeline kGzip{{FilterKind::shuffle, 4}, {FilterKind::deflate}};

ScratchPool pool_for(const FilterPipeline& pipeline, std::uint64_t memory) {
  return ScratchPool({4 * kMiB, most_stored_bytes(pipeline, 4 * kMiB), needs_other_buffer(pipeline), 0}, memory,
                     "run.h5: d");
}

TEST(ChunkScratch, AnEighthOfTheMemoryOrOneChunk) {
  const std::uint64_t one = pool_for(kGzip, 17 * kMiB).bytes();
  EXPECT_GE(one, 8 * kMiB);
  EXPECT_LT(one, 9 * kMiB);
  EXPECT_EQ(pool_for(kGzip, 17 * kMiB).size(), 1U);
  EXPECT_EQ(pool_for(kGzip, 120 * kMiB).size(), 1U);
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  EXPECT_EQ(pool_for(kGzip, 17 * 8 * kMiB).size(), std::min<std::size_t>(2, cores));
  EXPECT_EQ(pool_for(kGzip, 8 * 9 * kMiB * cores).size(), cores);
  EXPECT_EQ(pool_for(kGzip, 8192 * kMiB * cores).size(), cores);
  EXPECT_LT(pool_for({}, 17 * kMiB).bytes(), 5 * kMiB) << "chunks as they are need one buffer";
}

TEST(ChunkScratch, AChunkBeyondHalfTheMemoryIsRefused) {
  EXPECT_EQ(message_of_error(ErrorKind::usage, [] { pool_for(kGzip, 16 * kMiB); }),
            "run.h5: d: decoding one of its chunks of 4.0 MiB takes 8.1 MiB, more than half of --memory 16.0 MiB; give "
            "at least 73MiB");
}

TEST(ChunkScratch, NeverLendsMoreThanThePoolHolds) {
  ScratchPool pool = pool_for(kGzip, 17 * kMiB);
  ASSERT_EQ(pool.size(), 1U);
  std::atomic<int> holders{0};
  std::vector<std::jthread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&] {
      for (int turn = 0; turn < 100; ++turn) {
        const ScratchPool::Lease lease(pool);
        EXPECT_EQ(++holders, 1);
        (*lease).buffer.bytes()[0] = std::byte{1};
        --holders;
      }
    });
  }
}

}  // namespace
}  // namespace weir::chunk_scratch_test
