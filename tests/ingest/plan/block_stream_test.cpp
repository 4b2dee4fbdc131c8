#include "ingest/plan/block_stream.h"

#include <algorithm>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include "format/base/text.h"
#include "ingest/source/held_leaves.h"
#include "tests/ingest/support/scratch.h"

namespace weir::block_stream_test {
namespace {

class NoLeaves final : public HeldLeaves {
 public:
  std::span<const float> leaf(const Box& /*inside*/, std::array<float, kLeafVoxels>& /*room*/) const override {
    return {};
  }
};
const NoLeaves kNoLeaves;

/// A source in which each value is its linear index. It can fail at one read, or from one layer on. It records the
/// reading threads and the buffers that they read into.
class CountingSource final : public VolumeSource {
 public:
  explicit CountingSource(const Index3& extent) { info_.extent = extent; }

  const SourceInfo& info() const override { return info_; }
  AccessShape access() const override {
    AccessShape shape;
    shape.chunk = chunk;
    return shape;
  }
  const HeldLeaves* held(const Box& box) const override { return box.lo.z == held_z ? &kNoLeaves : nullptr; }
  std::uint64_t bytes_read() const override { return 0; }
  std::uint64_t working_bytes() const override { return own_bytes; }
  ConversionLoss read(const Box& box, std::span<float> values) override {
    const std::size_t n = reads.fetch_add(1);
    if (n == fail_at) throw Error(ErrorKind::input, "cut short");
    if (box.lo.z >= fail_z) throw Error(ErrorKind::input, cat("cut short at ", box.lo.z));
    EXPECT_EQ(std::ssize(values), box.voxels());
    {
      const std::lock_guard lock(mutex);
      readers.insert(std::this_thread::get_id());
      buffers.insert(values.data());
    }
    std::size_t i = 0;
    for (std::int64_t z = box.lo.z; z < box.hi.z; ++z) {
      for (std::int64_t y = box.lo.y; y < box.hi.y; ++y) {
        for (std::int64_t x = box.lo.x; x < box.hi.x; ++x) {
          values[i++] = static_cast<float>(linear_index({x, y, z}, info_.extent));
        }
      }
    }
    return {static_cast<std::uint64_t>(box.voxels()), n, static_cast<double>(n)};
  }

  std::atomic<std::size_t> reads{0};
  std::size_t fail_at = SIZE_MAX;
  std::int64_t fail_z = INT64_MAX;
  std::int64_t held_z = -1;
  Index3 chunk{};
  std::uint64_t own_bytes = 0;  // memory that a read takes
  std::mutex mutex;
  std::set<std::thread::id> readers;
  std::set<const float*> buffers;

 private:
  SourceInfo info_;
};

std::vector<Box> slabs(std::int64_t count) {
  std::vector<Box> boxes;
  for (std::int64_t z = 0; z < count; ++z) boxes.push_back({{0, 0, z}, {5, 3, z + 1}});
  return boxes;
}

TEST(BlockStream, HandsOutBlocksInOrderWithTheirValues) {
  CountingSource source({5, 3, 40});
  auto boxes = slabs(40);
  std::swap(boxes[3], boxes[30]);  // blocks come in the order of the list, not of their place
  boxes[7] = {{1, 1, 7}, {2, 3, 9}};
  std::size_t next = 0;
  std::vector<std::int64_t> done;
  StreamOptions options;
  std::int64_t voxels = 0;
  for (const Box& box : boxes) voxels += box.voxels();
  options.progress = [&](std::int64_t so_far, std::int64_t total) {
    EXPECT_EQ(total, voxels);
    done.push_back(so_far);
  };
  const auto caller = std::this_thread::get_id();
  const ConversionLoss loss = stream_blocks(source, boxes, options, [&](const Block& block) {
    EXPECT_EQ(std::this_thread::get_id(), caller);
    ASSERT_EQ(block.index, next);
    EXPECT_EQ(block.voxels, boxes[next]);
    ASSERT_EQ(std::ssize(block.values), boxes[next].voxels());
    EXPECT_EQ(block.values.front(), static_cast<float>(linear_index(boxes[next].lo, {5, 3, 40})));
    EXPECT_EQ(block.values.back(), static_cast<float>(linear_index(boxes[next].hi - Index3{1, 1, 1}, {5, 3, 40})));
    ++next;
  });
  EXPECT_EQ(next, 40U);
  EXPECT_EQ(loss.inexact, static_cast<std::uint64_t>(voxels));
  EXPECT_EQ(loss.overflow, 39U * 40U / 2U);
  EXPECT_EQ(loss.max_abs_error, 39.0);
  ASSERT_EQ(done.size(), 40U);
  EXPECT_TRUE(std::is_sorted(done.begin(), done.end()));
  EXPECT_EQ(done.back(), voxels);
  EXPECT_EQ(source.readers.size(), 1U);
  EXPECT_FALSE(source.readers.contains(caller));
  EXPECT_EQ(source.buffers.size(), 2U);
}

TEST(BlockStream, ReadsTheNextBlockDuringTheWork) {
  CountingSource source({5, 3, 8});
  stream_blocks(source, slabs(8), {}, [&](const Block& block) {
    // This would wait forever if the next block were read only after the work on this one.
    while (source.reads < std::min<std::size_t>(block.index + 2, 8)) std::this_thread::yield();
    EXPECT_LE(source.reads, block.index + 2);
  });
  EXPECT_EQ(source.reads, 8U);
}

// The bytes of each block of slabs().
constexpr std::uint64_t kSlabBytes = 5 * 3 * sizeof(float);

TEST(BlockStream, ReadsAsManyBlocksAheadAsItsBuffersHold) {
  for (const auto& [bytes, ahead] : {std::pair{std::uint64_t{0}, 2U}, {4 * kSlabBytes, 4U}, {100 * kSlabBytes, 8U}}) {
    CountingSource source({5, 3, 40});
    StreamOptions options;
    options.buffer_bytes = bytes;
    std::size_t next = 0;
    const ConversionLoss loss = stream_blocks(source, slabs(40), options, [&, most_ahead = ahead](const Block& block) {
      ASSERT_EQ(block.index, next++);
      ASSERT_EQ(block.values[7], static_cast<float>(15 * block.index + 7));
      const auto most = std::min<std::size_t>(block.index + most_ahead, 40);
      while (source.reads < most) std::this_thread::yield();
      EXPECT_LE(source.reads, most);
    });
    EXPECT_EQ(next, 40U);
    EXPECT_EQ(loss.overflow, 39U * 40U / 2U);
    EXPECT_EQ(source.buffers.size(), ahead);
    EXPECT_LE(source.readers.size(), ahead == 2 ? 1U : 2U);
  }
}

TEST(BlockStream, ChunksAndWhatTakesMemoryOfItsOwnAreReadByOneThread) {
  for (const bool chunks : {true, false}) {
    CountingSource source({5, 3, 40});
    if (chunks) source.chunk = {5, 3, 2};
    if (!chunks) source.own_bytes = 1;
    StreamOptions options;
    options.buffer_bytes = 8 * kSlabBytes;
    stream_blocks(source, slabs(40), options, [](const Block&) {});
    EXPECT_EQ(source.readers.size(), 1U);
  }
}

TEST(BlockStream, AnErrorThatTwoReadersMeetStopsAfterTheBlocksBefore) {
  StreamOptions options;
  options.buffer_bytes = 4 * kSlabBytes;
  for (std::int64_t fail_z = 0; fail_z < 200; ++fail_z) {
    CountingSource source({5, 3, 200});
    source.fail_z = fail_z;
    std::int64_t worked = 0;
    const auto message = message_of_error(
        ErrorKind::input, [&] { stream_blocks(source, slabs(200), options, [&](const Block&) { ++worked; }); });
    EXPECT_EQ(message, cat("cut short at ", fail_z));
    EXPECT_EQ(worked, fail_z);
  }
}

TEST(BlockStream, WorkThatFailsEndsTwoReaders) {
  StreamOptions options;
  options.buffer_bytes = 4 * kSlabBytes;
  CountingSource source({5, 3, 200});
  EXPECT_THROW(stream_blocks(source, slabs(200), options,
                             [](const Block& block) {
                               if (block.index == 50) throw std::runtime_error("work");
                             }),
               std::runtime_error);
  EXPECT_LE(source.reads, 54U);
}

TEST(BlockStream, LeavesThatLieInMemoryAreNotReadWhereBlocksComeInParts) {
  CountingSource source({5, 3, 8});
  source.held_z = 3;
  StreamOptions options;
  for (const bool in_parts : {false, true}) {
    source.reads = 0;
    options.in_parts = in_parts;
    stream_blocks(source, slabs(8), options, [&](const Block& block) {
      EXPECT_EQ(block.held, in_parts && block.index == 3 ? &kNoLeaves : nullptr);
    });
    EXPECT_EQ(source.reads, in_parts ? 7U : 8U);
  }
}

TEST(BlockStream, NoBoxes_ReadsNothing) {
  CountingSource source({5, 3, 8});
  const auto loss = stream_blocks(source, {}, {}, [](const Block&) { FAIL(); });
  EXPECT_EQ(loss.inexact, 0U);
  EXPECT_EQ(source.reads, 0U);
}

TEST(BlockStream, OneBoxNeedsOneBuffer) {
  CountingSource source({5, 3, 8});
  int calls = 0;
  stream_blocks(source, slabs(1), {}, [&](const Block& block) {
    EXPECT_EQ(block.values[14], 14.0F);
    ++calls;
  });
  EXPECT_EQ(calls, 1);
  EXPECT_EQ(source.buffers.size(), 1U);
}

TEST(BlockStream, SourceErrorStopsAfterTheBlocksReadBefore) {
  for (const std::size_t fail_at : {0U, 1U, 5U, 19U}) {
    CountingSource source({5, 3, 20});
    source.fail_at = fail_at;
    std::size_t worked = 0;
    const auto message = message_of_error(
        ErrorKind::input, [&] { stream_blocks(source, slabs(20), {}, [&](const Block&) { ++worked; }); });
    EXPECT_EQ(message, "cut short");
    EXPECT_EQ(worked, fail_at);
    EXPECT_EQ(source.reads, fail_at + 1);
  }
}

TEST(BlockStream, WorkErrorEndsBoth) {
  for (const std::size_t fail_at : {0U, 1U, 5U, 19U}) {
    CountingSource source({5, 3, 20});
    EXPECT_THROW(stream_blocks(source, slabs(20), {},
                               [&](const Block& block) {
                                 if (block.index == fail_at) throw std::domain_error("NaN");
                               }),
                 std::domain_error);
    EXPECT_LE(source.reads, fail_at + 2);  // the read of the next block may have begun
  }
}

TEST(BlockStream, BothSidesFail_ThrowsTheErrorOfTheWork) {
  CountingSource source({5, 3, 20});
  source.fail_at = 4;
  EXPECT_THROW(stream_blocks(source, slabs(20), {},
                             [&](const Block& block) {
                               if (block.index == 3) {
                                 while (source.reads < 5) std::this_thread::yield();
                                 throw std::domain_error("NaN");
                               }
                             }),
               std::domain_error);
}

TEST(BlockStream, CancelBeforeDuringAndByProgress) {
  std::atomic<bool> cancel{true};
  StreamOptions options;
  options.cancel = &cancel;
  CountingSource source({5, 3, 20});
  const auto before = message_of_error(
      ErrorKind::interrupted, [&] { stream_blocks(source, slabs(20), options, [](const Block&) { FAIL(); }); });
  EXPECT_EQ(before, "interrupted");
  EXPECT_EQ(source.reads, 0U);

  cancel = false;
  std::size_t worked = 0;
  message_of_error(ErrorKind::interrupted, [&] {
    stream_blocks(source, slabs(20), options, [&](const Block& block) {
      ++worked;
      if (block.index == 2) cancel = true;
    });
  });
  EXPECT_EQ(worked, 3U);

  cancel = false;
  worked = 0;
  options.progress = [&](std::int64_t done, std::int64_t) { cancel = done == 2 * 15; };
  message_of_error(ErrorKind::interrupted,
                   [&] { stream_blocks(source, slabs(20), options, [&](const Block&) { ++worked; }); });
  EXPECT_EQ(worked, 2U);
}

TEST(BlockStream, CancelFromAnotherThread) {
  CountingSource source({5, 3, 200});
  std::atomic<bool> cancel{false};
  StreamOptions options;
  options.cancel = &cancel;
  std::size_t worked = 0;
  std::jthread other;
  message_of_error(ErrorKind::interrupted, [&] {
    stream_blocks(source, slabs(200), options, [&](const Block& block) {
      ++worked;
      if (block.index == 100) other = std::jthread([&] { cancel = true; });
      while (block.index == 100 && !cancel) std::this_thread::yield();
    });
  });
  EXPECT_EQ(worked, 101U);
}

TEST(BlockStream, CallsAtRestAfterEachBlockAndGivesItsLoss) {
  CountingSource source({5, 3, 40});
  StreamOptions options;
  std::size_t worked = 0;
  std::size_t rests = 0;
  options.at_rest = [&](std::size_t done) {
    EXPECT_EQ(done, worked);
    ++rests;
  };
  stream_blocks(source, slabs(40), options, [&](const Block& block) {
    EXPECT_EQ(block.loss.overflow, block.index) << "of this block, whatever has been read meanwhile";
    EXPECT_EQ(block.loss.inexact, 15U);
    ++worked;
  });
  EXPECT_EQ(rests, 40U);
}

TEST(BlockStream, CancelDuringAtRest_CallsAtRestOnceMore) {
  CountingSource source({5, 3, 40});
  std::atomic<bool> cancel{false};
  std::vector<std::size_t> rests;
  StreamOptions options;
  options.cancel = &cancel;
  options.at_rest = [&](std::size_t done) {
    rests.push_back(done);
    if (done == 3) cancel = true;  // like a signal that arrives after the flag was checked
  };
  std::size_t worked = 0;
  message_of_error(ErrorKind::interrupted,
                   [&] { stream_blocks(source, slabs(40), options, [&](const Block&) { ++worked; }); });
  EXPECT_EQ(rests, (std::vector<std::size_t>{1, 2, 3, 3}));
  EXPECT_EQ(worked, 3U);
}

// work_in_place() reads groups of 64 Mi voxels, here two blocks. A group that has begun is finished.
TEST(BlockStream, InPlace_CallsAtRestAndCancelsBetweenGroups) {
  class Empty final : public VolumeSource {
   public:
    const SourceInfo& info() const override { return info_; }
    AccessShape access() const override { return {}; }
    std::uint64_t bytes_read() const override { return 0; }
    ConversionLoss read(const Box&, std::span<float>) override { return {1, 0, 0}; }

   private:
    SourceInfo info_;
  };
  Empty source;
  std::vector<Box> boxes;
  for (std::int64_t z = 0; z < 5; ++z) boxes.push_back({{0, 0, 32 * z}, {1024, 1024, 32 * (z + 1)}});
  std::atomic<std::size_t> worked{0};
  std::atomic<bool> cancel{false};
  std::vector<std::size_t> rests;
  StreamOptions options;
  options.cancel = &cancel;
  options.at_rest = [&](std::size_t done) {
    EXPECT_EQ(done, worked);
    rests.push_back(done);
  };
  EXPECT_EQ(work_in_place(source, boxes, options, [&](const Block&) { ++worked; }).inexact, 5U);
  EXPECT_EQ(rests, (std::vector<std::size_t>{2, 4, 5}));
  rests.clear();
  worked = 0;
  EXPECT_EQ(message_of_error(ErrorKind::interrupted,
                             [&] {
                               work_in_place(source, boxes, options, [&](const Block&) {
                                 ++worked;
                                 cancel = true;
                               });
                             }),
            "interrupted");
  EXPECT_EQ(rests, std::vector<std::size_t>{2});
  EXPECT_EQ(worked, 2U);
}

}  // namespace
}  // namespace weir::block_stream_test
