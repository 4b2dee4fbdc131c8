// Tests how often the objects of a sharded array are opened and read, and how many are held open. A store in memory
// counts this.
#include "ingest/zarr/storage/zarr_chunks.h"

#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "format/base/text.h"

namespace weir::zarr_chunks_test {
namespace {

constexpr std::uint64_t kNotStored = ShardPlace::kNone;

struct Counts {
  int opened = 0;
  int reads = 0;
  int open = 0;  // open now
};

class CountedObject final : public ZarrObject {
 public:
  CountedObject(const std::string& bytes, Counts& counts) : bytes_(bytes), counts_(counts) {
    ++counts_.opened;
    ++counts_.open;
  }
  CountedObject(const CountedObject&) = delete;
  CountedObject& operator=(const CountedObject&) = delete;
  ~CountedObject() override { --counts_.open; }

  std::uint64_t size() const override { return bytes_.size(); }
  void read(std::uint64_t offset, std::span<std::byte> into) override {
    ++counts_.reads;
    std::memcpy(into.data(), bytes_.data() + offset, into.size());
  }

 private:
  const std::string& bytes_;
  Counts& counts_;
};

class CountedStore final : public ZarrStore {
 public:
  std::map<std::string, std::string> objects;
  Counts counts;

  std::string shown(std::string_view key) const override { return "run.zarr/" + std::string(key); }
  std::string file_of(const std::string& key) const override { return shown(key); }
  bool is_one_file() const override { return false; }
  std::vector<std::string> groups_in(const std::string& /*key*/) override { return {}; }
  ZarrFound find(const std::string& key) override {
    if (!objects.contains(key)) return {};
    return {ZarrObjectState{objects.at(key).size()}, {}};
  }
  std::unique_ptr<ZarrObject> open(const std::string& key) override {
    return std::make_unique<CountedObject>(objects.at(key), counts);
  }
};

std::string index_text(const std::vector<std::uint64_t>& index) {
  return {reinterpret_cast<const char*>(index.data()), index.size() * sizeof(std::uint64_t)};
}

/// Returns a shard: the parts one after another, then an index of their places. Empty parts are not stored.
std::string shard_of(const std::vector<std::string>& parts) {
  std::string bytes;
  std::vector<std::uint64_t> index;
  for (const std::string& part : parts) {
    index.insert(index.end(), {part.empty() ? kNotStored : bytes.size(), part.empty() ? kNotStored : part.size()});
    bytes += part;
  }
  return bytes + index_text(index);
}

/// Returns an array of bytes in objects of `levels[0]` elements. Each object is a shard with chunks of `levels[1]`
/// elements, and so on.
ZarrArray bytes_in_shards(const std::vector<std::int64_t>& shape,
                          const std::vector<std::vector<std::int64_t>>& levels) {
  ZarrArray array;
  array.shape = shape;
  array.chunk = levels.front();
  array.type = ScalarType::uint8;
  for (std::size_t level = 1; level < levels.size(); ++level) {
    ZarrSharding sharding;
    sharding.chunk = levels[level];
    array.shards.push_back(sharding);
  }
  return array;
}

ZarrChunks chunks_of(CountedStore& store, const ZarrArray& array) {
  return {{store, "", array.keys}, array, ChunkGeometry(array, {}, "run.zarr"), std::uint64_t{64} << 20U, nullptr};
}

Box all_of(const ZarrArray& array) { return {{}, {array.shape[2], array.shape[1], array.shape[0]}}; }

TEST(ZarrChunks, MoreShardsInAShardThanAreKept_EachIndexIsReadOnce) {
  constexpr int kInner = 2 * static_cast<int>(OpenShards::kMostOpenShards);
  CountedStore store;
  std::vector<std::string> inner(kInner, shard_of({"a", "", "b", "c"}));
  inner[3].clear();
  store.objects["0.0.0"] = shard_of(inner);
  // The array has two planes, so a walk along x comes to every inner shard twice.
  const ZarrArray array = bytes_in_shards({2, 1, 2 * kInner}, {{2, 1, 2 * kInner}, {2, 1, 2}, {1, 1, 1}});
  ZarrChunks chunks = chunks_of(store, array);
  const UnstoredChunks unstored = chunks.count_unstored(all_of(array));
  EXPECT_EQ(unstored.count, kInner - 1 + 4U);
  EXPECT_EQ(unstored.all, 4U * kInner);
  EXPECT_EQ(unstored.first, "run.zarr/0.0.0: chunk at 0, 0, 1");
  EXPECT_EQ(store.counts.reads, 1 + kInner - 1);
  EXPECT_EQ(store.counts.opened, 1);
}

TEST(ZarrChunks, ShardsThatTheVolumeEndsIn_AreCountedAsFarAsItGoes) {
  CountedStore store;
  const std::string inner = shard_of({"a", "", "", ""});
  const std::string third = shard_of({inner, "", inner, inner});
  store.objects["0.0.0"] = shard_of({third, third});
  // Along x, an object has 16 elements, a shard in it 8, an innermost shard 2, a chunk 1. Along z, each kind of shard
  // has 2 elements. The volume has 11 elements along x.
  ZarrArray array = bytes_in_shards({2, 1, 11}, {{2, 1, 16}, {2, 1, 8}, {2, 1, 2}, {1, 1, 1}});
  ZarrChunks chunks = chunks_of(store, array);
  const UnstoredChunks unstored = chunks.count_unstored(all_of(array));
  EXPECT_EQ(unstored.all, 22U);
  EXPECT_EQ(unstored.count, 22U - 4U) << "the first chunk of innermost shards 0, 2, 3 and 4 is stored";
  EXPECT_EQ(store.counts.reads, 1 + 2 + 4);
  const UnstoredChunks of_region = chunks.count_unstored({{5, 0, 0}, {11, 1, 2}});
  EXPECT_EQ(of_region.all, 12U);
  EXPECT_EQ(of_region.count, 12U - 2U) << "of those stored at x = 0, 4, 6 and 8";
  EXPECT_EQ(of_region.first, "run.zarr/0.0.0: chunk at 0, 0, 5");
}

TEST(ZarrChunks, ObjectsHeldOpen_AreBoundedOverAllLevels) {
  constexpr std::int64_t kMost = OpenShards::kMostOpenShards;
  CountedStore store;
  for (std::int64_t i = 0; i < 2 * kMost; ++i) {
    // Later objects have no inner shard. So the inner level keeps only objects of the first half.
    store.objects[cat("0.0.", i)] = i < kMost ? shard_of({shard_of({"a", "b"})}) : shard_of({""});
  }
  const ZarrArray array = bytes_in_shards({1, 1, 4 * kMost}, {{1, 1, 2}, {1, 1, 2}, {1, 1, 1}});
  ZarrChunks chunks = chunks_of(store, array);
  EXPECT_EQ(chunks.count_unstored(all_of(array)).count, static_cast<std::uint64_t>(2 * kMost));
  EXPECT_EQ(store.counts.open, kMost);
}

}  // namespace
}  // namespace weir::zarr_chunks_test
