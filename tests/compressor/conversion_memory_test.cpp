#include "compressor/conversion_memory.h"

#include <gtest/gtest.h>

#include "compressor/survey/leaf_cache.h"

namespace weir::conversion_memory_test {
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20U;
constexpr std::uint64_t kResident = 30 * kMiB;

/// A volume that is only planned and never read.
class Planned final : public VolumeSource {
 public:
  explicit Planned(const Index3& extent) { info_.extent = extent; }
  const SourceInfo& info() const override { return info_; }
  AccessShape access() const override { return {}; }
  ConversionLoss read(const Box& /*box*/, std::span<float> /*values*/) override { return {}; }
  bool in_memory() const override { return in_memory_; }
  std::vector<RepeatedPart> repeated_parts(const Box& box) const override {
    return {coarse_ ? RepeatedPart{box, {2, 2, 2}} : RepeatedPart{box}};
  }
  std::uint64_t bytes_read() const override { return 0; }

  bool in_memory_ = false;
  bool coarse_ = false;

 private:
  SourceInfo info_;
};

MemoryShares shares_of(Planned& volume, std::uint64_t ceiling, bool may_hold = true, std::size_t threads = 2) {
  ConversionOptions options;
  options.memory = ceiling;
  return share_memory(volume, options, kResident, threads, may_hold);
}

TEST(ConversionMemory, KeepsValuesInWhatIsLeft) {
  Planned volume({1024, 1024, 1024});
  EXPECT_EQ(shares_of(volume, 512 * kMiB).cache_bytes, 0U);
  EXPECT_EQ(shares_of(volume, 1566 * kMiB, false).cache_bytes, 768 * kMiB);  // 3/4 of the memory beyond 512 and 30 MiB
  EXPECT_EQ(shares_of(volume, 16384 * kMiB).cache_bytes,
            LeafCache::whole_bytes(make_lattice(volume.info().domain(), kLeafDim)));
  Planned small({160, 160, 160});
  EXPECT_GT(shares_of(small, 128 * kMiB).cache_bytes, 0U);
}

TEST(ConversionMemory, KeepsNothingThatIsInMemoryOrComesOnceForManyVoxels) {
  Planned volume({512, 512, 512});
  volume.coarse_ = true;
  EXPECT_EQ(shares_of(volume, 4096 * kMiB).cache_bytes, 0U);
  volume.coarse_ = false;
  EXPECT_GT(shares_of(volume, 4096 * kMiB).cache_bytes, 0U);
  volume.in_memory_ = true;
  EXPECT_EQ(shares_of(volume, 4096 * kMiB).cache_bytes, 0U);
}

TEST(ConversionMemory, KeptValuesDoNotDriveRecordsOutOfMemory) {
  Planned volume({1024, 1024, 1024});
  Planned in_memory({1024, 1024, 1024});
  in_memory.in_memory_ = true;
  int held = 0;
  int kept = 0;
  for (std::uint64_t ceiling = 600 * kMiB; ceiling < 4096 * kMiB; ceiling += 100 * kMiB) {
    const MemoryShares shares = shares_of(volume, ceiling);
    EXPECT_EQ(shares.memory.record_bytes > 0, shares_of(in_memory, ceiling).memory.record_bytes > 0) << ceiling;
    held += shares.memory.record_bytes > 0 ? 1 : 0;
    kept += shares.cache_bytes > 0 ? 1 : 0;
  }
  EXPECT_GT(held, 10);
  EXPECT_GT(kept, 10);
}

TEST(ConversionMemory, ManyThreadsLeaveLessToKeep) {
  Planned volume({1024, 1024, 1024});
  const MemoryShares shares = shares_of(volume, 1000 * kMiB, false, 160);
  EXPECT_GT(shares.cache_bytes, 0U);
  EXPECT_LT(shares.cache_bytes, shares_of(volume, 1000 * kMiB, false).cache_bytes);
}

}  // namespace
}  // namespace weir::conversion_memory_test
