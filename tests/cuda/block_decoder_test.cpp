// The device decodes packed blocks to exactly the bits that the host decodes.
#include "gpu/cuda/packed/block_decoder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "format/nanovdb/nvdb_grid.h"
#include "tests/cuda/support/device_reads.h"
#include "tests/support/packed_kinds.h"

namespace weir::block_decoder_test {
namespace {

class BlockDecoderTest : public testing::Test {
 protected:
  BlockDecoderTest() : file_(test::build_packed_kinds()), grid_(NvdbGrid::open(file_.file, "a.nvdb")) {
    for (std::int64_t r = 0; r < packed().regions().size(); ++r) {
      for (std::uint64_t position = 0; position < 4096; ++position) {
        blocks_.push_back(static_cast<BlockId>(r) << 12U | position);
      }
    }
  }

  const PackedData& packed() const { return *grid_.packed(); }
  std::array<float, 512> expected(BlockId id) const {
    const PackedRegion region = packed().region(packed().regions().position(static_cast<std::int64_t>(id >> 12U)));
    std::array<float, 512> values;
    values.fill(region.value);
    if (region.chunk == 0) return values;
    const PackedStream stream = packed().stream(region, static_cast<unsigned>(id & 4095U));
    if (stream.data != nullptr) packed().decode(stream, values);
    return values;
  }

  test::PackedFile file_;
  NvdbGrid grid_;
  std::vector<BlockId> blocks_;
};

TEST_F(BlockDecoderTest, GivesTheBitsThatTheHostDecodes) {
  WEIR_NEEDS_DEVICE();
  BlockDecoder decoder(packed());
  const DeviceArray<BlockId> ids{std::span<const BlockId>(blocks_)};
  const DeviceArray<float> device(512 * blocks_.size());
  // Once in one call, and once in calls of a few blocks.
  for (const std::size_t batch : {blocks_.size(), std::size_t{97}}) {
    for (std::size_t first = 0; first < blocks_.size(); first += batch) {
      const std::size_t count = std::min(batch, blocks_.size() - first);
      decoder.decode(ids.data() + first, count, device.data() + 512 * first, cudaStreamPerThread);
    }
    EXPECT_EQ(decoder.counts(cudaStreamPerThread).damaged, 0U);
    const std::vector<float> values = device.download();
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      const std::array<float, 512> host = expected(blocks_[i]);
      ASSERT_EQ(std::memcmp(host.data(), values.data() + 512 * i, sizeof host), 0) << i;
    }
  }
}

TEST_F(BlockDecoderTest, TakesTheNumberOfBlocksFromTheDevice) {
  WEIR_NEEDS_DEVICE();
  BlockDecoder decoder(packed());
  const DeviceArray<BlockId> ids{std::span<const BlockId>(blocks_)};
  for (const std::uint32_t available : {0U, 50U, 1000000U}) {
    const DeviceArray<std::uint32_t> count{std::span<const std::uint32_t>(&available, 1)};
    DeviceArray<float> device(std::size_t{512} * 100);
    device.upload(std::vector<float>(device.size(), -1.0F));
    decoder.decode(ids.data(), 100, count.data(), device.data(), cudaStreamPerThread);
    EXPECT_EQ(decoder.counts(cudaStreamPerThread).damaged, 0U);
    const std::vector<float> values = device.download();
    for (std::size_t i = 0; i < 100; ++i) {
      std::array<float, 512> wanted;
      wanted.fill(-1.0F);
      if (i < available) wanted = expected(blocks_[i]);
      ASSERT_EQ(std::memcmp(wanted.data(), values.data() + 512 * i, sizeof wanted), 0) << i;
    }
  }
}

TEST_F(BlockDecoderTest, ABlockOutsideTheGridIsNaNAndCounted) {
  WEIR_NEEDS_DEVICE();
  BlockDecoder decoder(packed());
  const std::vector<BlockId> outside{blocks_.size(), 0};
  const DeviceArray<BlockId> ids{std::span<const BlockId>(outside)};
  const DeviceArray<float> device(512 * outside.size());
  decoder.decode(ids.data(), outside.size(), device.data(), cudaStreamPerThread);
  EXPECT_EQ(decoder.counts(cudaStreamPerThread).damaged, 1U);
  EXPECT_EQ(decoder.counts(cudaStreamPerThread).damaged, 0U) << "since the last question";
  const std::vector<float> values = device.download();
  EXPECT_TRUE(std::isnan(values[0]));
  EXPECT_EQ(values[512], expected(0)[0]);
}

}  // namespace
}  // namespace weir::block_decoder_test
