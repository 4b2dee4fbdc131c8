// Tests reads of boxes from chunks: the values, and that several threads decode each chunk once.
#include "ingest/chunks/chunk_boxes.h"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <map>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include "format/base/error.h"
#include "tests/support/message_of_error.h"

namespace weir::chunk_boxes_test {
namespace {

constexpr Index3 kChunk{4, 3, 2};
constexpr Index3 kExtent{10, 7, 5};
constexpr std::size_t kChunkBytes = 4 * 3 * 2 * sizeof(float);

float value_at(const Index3& i) { return static_cast<float>(i.x + 100 * i.y + 10000 * i.z); }

ChunkedVolume volume() {
  ChunkedVolume volume;
  volume.name = "a.h5: v";
  volume.extent = kExtent;
  volume.chunk = kChunk;
  const float fill = -1;
  volume.fill.resize(sizeof fill);
  std::memcpy(volume.fill.data(), &fill, sizeof fill);
  return volume;
}

/// Makes chunks of value_at(). The chunk at `missing` is not stored. Records how often each chunk is decoded, and by
/// which threads.
class MadeChunks : public StoredChunks {
 public:
  std::span<const std::byte> decode(const Index3& chunk, ChunkScratch& scratch) override {
    {
      std::unique_lock lock(mutex_);
      ++decoded[{chunk.x, chunk.y, chunk.z}];
      threads.insert(std::this_thread::get_id());
      arrived_.notify_all();
      // The first thread waits until another thread has a chunk, too.
      if (meet) arrived_.wait_for(lock, std::chrono::seconds(30), [&] { return threads.size() > 1; });
    }
    if (chunk == missing) return {};
    std::byte* out = scratch.buffer.bytes().data();
    const Index3 lo{chunk.x * kChunk.x, chunk.y * kChunk.y, chunk.z * kChunk.z};
    for_each_index(Box{lo, lo + kChunk}, [&](const Index3& i) {
      const float value = value_at(i);
      std::memcpy(out, &value, sizeof value);
      out += sizeof value;
    });
    return {scratch.buffer.bytes().data(), kChunkBytes};
  }

  Index3 missing{-1, -1, -1};
  bool meet = false;
  std::map<std::array<std::int64_t, 3>, int> decoded;
  std::set<std::thread::id> threads;

 private:
  std::mutex mutex_;
  std::condition_variable arrived_;
};

struct Boxes {
  Boxes() : pool({kChunkBytes, kChunkBytes, false, 0}, 64U << 20U, "a.h5: v"), boxes(volume(), chunks, pool) {}

  std::vector<float> read(const Box& box) {
    std::vector<float> values(static_cast<std::size_t>(box.voxels()));
    boxes.read(box, values);
    return values;
  }

  MadeChunks chunks;
  ScratchPool pool;
  ChunkBoxes boxes;
};

TEST(ChunkBoxes, EveryBoxHasItsValuesAndDecodesEachOfItsChunksOnce) {
  const std::vector<Box> all{
      {{0, 0, 0}, kExtent}, {{3, 2, 1}, {5, 4, 3}}, {{4, 3, 2}, {8, 6, 4}}, {{9, 6, 4}, kExtent}};
  const std::vector<std::size_t> chunks{27, 8, 1, 1};
  for (std::size_t n = 0; n < all.size(); ++n) {
    Boxes made;
    made.chunks.missing = {1, 1, 1};
    const std::vector<float> values = made.read(all[n]);
    std::size_t at = 0;
    for_each_index(all[n], [&](const Index3& i) {
      const bool missing = i.x / kChunk.x == 1 && i.y / kChunk.y == 1 && i.z / kChunk.z == 1;
      ASSERT_EQ(values[at++], missing ? -1 : value_at(i)) << i.x << ' ' << i.y << ' ' << i.z;
    });
    EXPECT_EQ(made.chunks.decoded.size(), chunks[n]);
    for (const auto& [chunk, times] : made.chunks.decoded) EXPECT_EQ(times, 1);
  }
}

TEST(ChunkBoxes, ABoxIsDecodedBySeveralThreads) {
  if (std::thread::hardware_concurrency() < 2) GTEST_SKIP() << "one core";
  Boxes made;
  made.chunks.meet = true;
  made.read({{0, 0, 0}, kExtent});
  EXPECT_GT(made.chunks.threads.size(), 1U);
}

TEST(ChunkBoxes, ABoxThatIsNotInside_IsAnError) {
  Boxes made;
  EXPECT_EQ(message_of_error(ErrorKind::internal,
                             [&] {
                               made.read({{8, 0, 0}, {11, 1, 1}});
                             }),
            "a.h5: v: read of box 8:11,0:1,0:1 into 3 values does not fit 0:10,0:7,0:5");
}

}  // namespace
}  // namespace weir::chunk_boxes_test
