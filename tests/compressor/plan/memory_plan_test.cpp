#include "compressor/plan/memory_plan.h"

#include <gtest/gtest.h>

#include <regex>
#include <string>

#include "format/base/error.h"
#include "ingest/plan/staging.h"

namespace weir::memory_plan_test {
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20U;
const Box kLarge{{0, 0, 0}, {3000, 3000, 3000}};

TEST(MemoryPlan, TwoBlocksAndEveryThreadsRowsFitTheCeiling) {
  for (const std::uint64_t ceiling : {256 * kMiB, 300 * kMiB, 512 * kMiB, 4096 * kMiB}) {
    for (const std::size_t threads : {1U, 2U, 7U, 16U}) {
      for (const std::uint64_t resident : {10 * kMiB, 60 * kMiB}) {
        const MemoryPlan plan = plan_memory(ceiling, resident, threads, kLarge);
        const std::uint64_t rows =
            threads * static_cast<std::uint64_t>(plan.selection.segment_regions) * 16 * 16 * 16 * sizeof(float) * 12;
        // The passes come one after the other, so blocks and rows are never in memory together.
        EXPECT_LT(resident + kStagingBytes + 2 * plan.block_bytes, ceiling);
        EXPECT_LT(resident + kStagingBytes + rows, ceiling);
        EXPECT_GE(plan.block_bytes, kMiB);
        EXPECT_GE(plan.selection.segment_regions, 1);
      }
    }
  }
}

TEST(MemoryPlan, SelectionsRowsAndStepsFitWhatIsThere) {
  constexpr std::uint64_t kRegionBytes = 8 * kMiB;  // a region of packed blocks
  for (const std::size_t threads : {1U, 2U, 16U}) {
    for (std::uint64_t ceiling = 64 * kMiB; ceiling < 2048 * kMiB; ceiling += 7 * kMiB) {
      MemoryPlan plan;
      try {
        plan = plan_memory(ceiling, 10 * kMiB, threads, kLarge, kRegionBytes);
      } catch (const Error&) {
        continue;  // too little memory for `threads` threads
      }
      const std::uint64_t walk = threads * static_cast<std::uint64_t>(plan.selection.segment_regions) * kRegionBytes;
      EXPECT_LE(plan.fixed_bytes + walk + plan.selection.step_bytes, ceiling) << threads << " threads";
      if (plan.selection.segment_regions > 1) {
        EXPECT_GE(plan.selection.step_bytes, walk / 2);
      }
    }
  }
}

TEST(MemoryPlan, RecordsStayInMemoryWhereTheyTakeNoMoreThanAQuarter) {
  const std::uint64_t records = 100 * kMiB;
  std::uint64_t least = 0;  // least ceiling that holds the records
  for (std::uint64_t ceiling = 200 * kMiB; ceiling < 1024 * kMiB; ceiling += kMiB) {
    const MemoryPlan plan = plan_memory(ceiling, 30 * kMiB, 4, kLarge, kRegionRowsBytes, records);
    const MemoryPlan without = plan_memory(ceiling, 30 * kMiB, 4, kLarge);
    if (plan.record_bytes == 0) {
      EXPECT_EQ(least, 0U) << ceiling;
      EXPECT_EQ(plan.block_bytes, without.block_bytes);
      continue;
    }
    if (least == 0) least = ceiling;
    EXPECT_EQ(plan.record_bytes, records);
    EXPECT_LT(30 * kMiB + kStagingBytes + 2 * plan.block_bytes + records, ceiling);
    EXPECT_GE(plan.block_bytes, without.block_bytes / 4 * 3 - kMiB);
  }
  EXPECT_GT(least, 4 * records);
  EXPECT_LT(least, 6 * records);
}

TEST(MemoryPlan, MoreMemoryNeverMeansSmallerShares) {
  MemoryPlan before;
  before.block_bytes = 0;
  before.selection.segment_regions = 0;
  for (std::uint64_t ceiling = 200 * kMiB; ceiling < 8192 * kMiB; ceiling += 97 * kMiB) {
    const MemoryPlan plan = plan_memory(ceiling, 30 * kMiB, 4, kLarge);
    EXPECT_GE(plan.block_bytes, before.block_bytes);
    EXPECT_GE(plan.selection.segment_regions, before.selection.segment_regions);
    before = plan;
  }
}

TEST(MemoryPlan, TooLittleIsRefusedWithASufficientMinimum) {
  for (const Box& domain : {Box{{0, 0, 0}, {1, 1, 1}}, kLarge, Box{{0, 0, 0}, {20000, 20000, 20000}}}) {
    for (const std::size_t threads : {1U, 64U}) {
      try {
        plan_memory(kMiB, 20 * kMiB, threads, domain);
        FAIL();
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::usage);
        const std::string message = error.what();
        std::smatch match;
        const std::regex form("--memory 1.0 MiB is too small for this volume with " + std::to_string(threads) +
                              (threads == 1 ? " thread" : " threads") + "; give at least ([0-9]+)MiB");
        ASSERT_TRUE(std::regex_match(message, match, form)) << message;
        EXPECT_NO_THROW(plan_memory(std::stoull(match[1]) * kMiB, 20 * kMiB, threads, domain));
        EXPECT_THROW(plan_memory((std::stoull(match[1]) - 2) * kMiB, 20 * kMiB, threads, domain), Error);
      }
    }
  }
}

TEST(MemoryPlan, CeilingForBlocks_HoldsBlocksOfThatSize) {
  const MemoryPlan plan = plan_memory(256 * kMiB, 30 * kMiB, 4, kLarge);
  for (const std::uint64_t block : {plan.block_bytes / 2, plan.block_bytes + 1, 512 * kMiB, 5000 * kMiB + 7}) {
    const std::uint64_t ceiling = ceiling_for_blocks(plan, 256 * kMiB, block);
    EXPECT_GE(plan_memory(ceiling, 30 * kMiB, 4, kLarge).block_bytes, block);
    if (block > plan.block_bytes) {
      EXPECT_LT(plan_memory(ceiling - 32, 30 * kMiB, 4, kLarge).block_bytes, block);
    }
  }
}

TEST(MemoryPlan, ThreadsDefaultToTheProcessorsThatTheCeilingHolds) {
  const auto chosen = [](std::size_t processors) {
    return choose_threads(0, processors, 512 * kMiB, 40 * kMiB, {{0, 0, 0}, {512, 512, 512}});
  };
  EXPECT_EQ(chosen(0), 1U);
  EXPECT_EQ(chosen(1), 1U);
  EXPECT_EQ(chosen(8), 8U);
  for (const std::size_t processors : {112U, 128U, 512U, 4096U}) {
    const std::size_t threads = chosen(processors);
    EXPECT_GT(threads, 48U) << processors;
    EXPECT_LT(threads, 112U) << processors;
    EXPECT_NO_THROW(plan_memory(512 * kMiB, 40 * kMiB, threads, {{0, 0, 0}, {512, 512, 512}}));
  }
}

TEST(MemoryPlan, ThreadsThatWereAskedForAreNotReduced) {
  EXPECT_EQ(choose_threads(300, 8, 64 * kMiB, 40 * kMiB, kLarge), 300U);
  EXPECT_EQ(choose_threads(0, 8, kMiB, 40 * kMiB, kLarge), 1U) << "the plan refuses it then";
}

TEST(MemoryPlan, NoticeNamesTheFewerThreads) {
  EXPECT_EQ(fewer_threads_notice(60, 128, 512 * kMiB).text(),
            "--memory 512.0 MiB holds 60 of 128 threads; give more to use them all");
}

}  // namespace
}  // namespace weir::memory_plan_test
