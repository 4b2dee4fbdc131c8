#include "compressor/forecast/read_probe.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "tests/compressor/support/memory_volume.h"

namespace weir::read_probe_test {
namespace {

// A volume that waits at each read.
class SlowVolume final : public VolumeSource {
 public:
  const SourceInfo& info() const override { return volume_.info(); }
  AccessShape access() const override { return volume_.access(); }
  ConversionLoss read(const Box& box, std::span<float> values) override {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    ++reads;
    return volume_.read(box, values);
  }
  std::uint64_t bytes_read() const override { return volume_.bytes_read(); }

  int reads = 0;

 private:
  test::MemoryVolume volume_{{{0, 0, 0}, {64, 64, 64}}, [](const Index3& i) { return static_cast<float>(i.x); }};
};

TEST(ReadProbe, ReadsEightBlocksOfThePlan) {
  SlowVolume volume;
  const BlockPlan plan = plan_blocks(volume.info().domain(), volume.access(), 64 * 8 * 8 * 4);
  ASSERT_EQ(plan.size(), 64);
  const ReadCost cost = probe_reading(volume, plan);
  EXPECT_EQ(volume.reads, 8);
  EXPECT_DOUBLE_EQ(cost.bytes, 4);
  EXPECT_GE(cost.wall_s, 8 * 0.005 / (8 * 4096));
  EXPECT_GE(cost.cpu_s, 0);
}

TEST(ReadProbe, FewBlocks_AreAllRead) {
  SlowVolume volume;
  const ReadCost cost = probe_reading(volume, plan_blocks(volume.info().domain(), volume.access(), 64 * 64 * 32 * 4));
  EXPECT_EQ(volume.reads, 2);
  EXPECT_DOUBLE_EQ(cost.bytes, 4);
}

}  // namespace
}  // namespace weir::read_probe_test
