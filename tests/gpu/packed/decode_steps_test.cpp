// The device's decoder of packed blocks on the host: threads that wait for each other as those of a device do give the
// bits that readers of files get.
#include "gpu/cuda/packed/decode_steps.h"

#include <gtest/gtest.h>

#include <atomic>
#include <barrier>
#include <cmath>
#include <cstring>
#include <memory>
#include <random>
#include <thread>
#include <vector>

#include "format/nanovdb/nvdb_grid.h"
#include "tests/support/packed_kinds.h"

namespace weir::decode_steps_test {
namespace {

constexpr unsigned kThreads = 2 * kWarp;
constexpr ScanPlaces kPlaces = make_scan_places();

struct Group {
  std::barrier<> all{kThreads};
  std::barrier<> warps[kThreads / kWarp]{std::barrier<>{kWarp}, std::barrier<>{kWarp}};
};

class HostThread {
 public:
  HostThread(Group& group, unsigned index) : group_(&group), index_(index) {}
  unsigned index() const { return index_; }
  unsigned count() const { return kThreads; }
  unsigned group() const { return 0; }
  unsigned groups() const { return 1; }
  void meet() const { group_->all.arrive_and_wait(); }
  void meet_warp() const { group_->warps[index_ / kWarp].arrive_and_wait(); }
  std::uint32_t add(std::uint32_t* counter, std::uint32_t n) const {
    return std::atomic_ref<std::uint32_t>(*counter).fetch_add(n);
  }

 private:
  Group* group_;
  unsigned index_;
};

struct Decoded {
  std::vector<float> values;
  std::uint32_t damaged = 0;
  std::uint32_t left = 0;
};

class DecodeSteps : public testing::Test {
 protected:
  explicit DecodeSteps(test::PackedFile file = test::build_packed_kinds())
      : file_(std::move(file)), grid_(NvdbGrid::open(file_.file, "a.nvdb")), data_(bytes_of(grid_)) {
    const NodeLattice& regions = grid_.packed()->regions();
    for (std::int64_t r = 0; r < regions.size(); ++r) {
      for (std::uint64_t position = 0; position < 4096; position += 3) {
        blocks_.push_back(static_cast<PackedBlockId>(r) << 12U | position);
      }
    }
  }

  // Of the bytes in data_, which may have been damaged.
  Decoded decode() {
    const PackedHeader& header = grid_.packed()->header();
    const std::size_t words = (data_.size() + 7) / 8;
    const auto copy = std::make_unique<std::uint64_t[]>(words);  // where the device has it: at a multiple of 8
    std::memcpy(copy.get(), data_.data(), data_.size());
    DecodeCall call;
    call.view.data = reinterpret_cast<const std::byte*>(copy.get());
    call.view.bytes = data_.size();
    call.view.table = header.table;
    call.view.regions = static_cast<std::uint64_t>(header.regions.size());
    call.view.constants = header.constants();
    call.blocks = blocks_.data();
    call.count = static_cast<std::uint32_t>(blocks_.size());
    Decoded decoded;
    decoded.values.resize(512 * blocks_.size());
    std::vector<std::uint32_t> left(blocks_.size());
    std::array<std::uint32_t, 2> counters{};
    call.values = decoded.values.data();
    call.left = left.data();
    call.counters = counters.data();
    run(call);
    decoded.damaged = counters[0];
    decoded.left = counters[1];
    return decoded;
  }

  static void run(const DecodeCall& call) {
    const std::size_t bytes = decode_layout(kThreads).bytes;
    const auto shared = std::make_unique<std::max_align_t[]>(bytes / sizeof(std::max_align_t) + 1);
    auto* memory = reinterpret_cast<unsigned char*>(shared.get());
    Group group;
    {
      std::vector<std::jthread> threads;
      for (unsigned i = 0; i < kThreads; ++i) {
        threads.emplace_back([&, i] { decode_blocks(HostThread(group, i), call, kPlaces, kBlockScan, memory); });
      }
    }
    std::vector<std::jthread> threads;
    for (unsigned i = 0; i < kThreads; ++i) {
      threads.emplace_back([&, i] { decode_left(HostThread(group, i), call, kBlockScan); });
    }
  }

  static std::vector<std::byte> bytes_of(const NvdbGrid& grid) {
    const std::span<const std::byte> bytes = grid.packed()->bytes();
    return {bytes.begin(), bytes.end()};
  }

  test::PackedFile file_;
  NvdbGrid grid_;
  std::vector<std::byte> data_;
  std::vector<PackedBlockId> blocks_;
};

TEST_F(DecodeSteps, GiveTheBitsThatReadersOfFilesGet) {
  const Decoded decoded = decode();
  EXPECT_EQ(decoded.damaged, 0U);
  const PackedData& packed = *grid_.packed();
  std::uint32_t transformed = 0;
  std::uint32_t others = 0;
  std::uint32_t large = 0;
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    const PackedRegion region = packed.region(packed.regions().position(static_cast<std::int64_t>(blocks_[i] >> 12U)));
    std::array<float, 512> expected;
    expected.fill(region.value);
    if (region.chunk != 0) {
      const PackedStream stream = packed.stream(region, static_cast<unsigned>(blocks_[i] & 4095U));
      if (stream.data != nullptr) {
        packed.decode(stream, expected);
        (packed_kind(stream) == PackedKind::transform ? transformed : others) += 1;
      }
    }
    ASSERT_EQ(std::memcmp(expected.data(), decoded.values.data() + 512 * i, sizeof expected), 0) << i;
  }
  EXPECT_GT(transformed, 100U);
  EXPECT_GT(others, 20U);
  EXPECT_GE(decoded.left, others);
  large = decoded.left - others;
  EXPECT_GT(large, 5U) << "magnitudes that shared memory has no room for";
  EXPECT_LT(large, transformed / 2);
}

// Whatever the bytes are, a block is NaN and counted, or some values; a sanitizer sees each read outside.
TEST_F(DecodeSteps, DamagedBytesAreCounted) {
  std::mt19937 random(5);
  const std::vector<std::byte> whole = data_;
  std::uint32_t damaged = 0;
  for (int trial = 0; trial < 40; ++trial) {
    data_ = whole;
    for (int n = 0; n < 200; ++n) {
      const std::size_t at =
          grid_.packed()->header().table + random() % (data_.size() - grid_.packed()->header().table);
      data_[at] = static_cast<std::byte>(random());
    }
    const Decoded decoded = decode();
    damaged += decoded.damaged;
    EXPECT_LE(decoded.damaged, blocks_.size());
  }
  EXPECT_GT(damaged, 300U);
}

TEST_F(DecodeSteps, ABlockOutsideTheGridIsDamaged) {
  blocks_ = {static_cast<PackedBlockId>(grid_.packed()->regions().size()) << 12U};
  const Decoded decoded = decode();
  EXPECT_EQ(decoded.damaged, 1U);
  EXPECT_TRUE(std::isnan(decoded.values[511]));
}

}  // namespace
}  // namespace weir::decode_steps_test
