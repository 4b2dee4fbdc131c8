// The device's decoder of packed blocks, run on the host: threads that wait for each other as on a device decode the
// same bits as file readers do.
#include "gpu/cuda/packed/decode_steps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <barrier>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "format/nanovdb/nvdb_grid.h"
#include "tests/support/packed_kinds.h"
#include "tests/support/sanitized.h"

namespace weir::decode_steps_test {
namespace {

constexpr unsigned kThreads = 2 * kWarp;

struct Group {
  std::barrier<> all{kThreads};
  std::barrier<> warps[kThreads / kWarp]{std::barrier<>{kWarp}, std::barrier<>{kWarp}};
  std::atomic<unsigned> votes[kThreads / kWarp]{};
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
  bool any_of_warp(bool own) const {
    std::atomic<unsigned>& votes = group_->votes[index_ / kWarp];
    if (own) ++votes;
    meet_warp();
    const bool any = votes > 0;
    meet_warp();
    if (own) --votes;
    meet_warp();
    return any;
  }
  void prefetch(const void*) const {}
  std::uint32_t add(std::uint32_t* counter, std::uint32_t n) const {
    return std::atomic_ref<std::uint32_t>(*counter).fetch_add(n);
  }

 private:
  Group* group_;
  unsigned index_;
};

struct alignas(16) BlockValues {
  float of[512] = {};
};

struct Decoded {
  std::vector<BlockValues> values;
  std::uint32_t damaged = 0;
  std::uint32_t wide = 0;
};

class DecodeSteps : public testing::Test {
 protected:
  explicit DecodeSteps(test::PackedFile file = test::build_packed_kinds())
      : file_(std::move(file)), grid_(NvdbGrid::open(file_.file, "a.nvdb")), data_(bytes_of(grid_)) {
    const NodeLattice& regions = grid_.packed()->regions();
    for (std::int64_t r = 0; r < regions.size(); ++r) {
      for (std::uint64_t position = 0; position < 4096; position += 3) {
        blocks_.push_back(static_cast<BlockId>(r) << 12U | position);
      }
    }
  }

  // Decodes the bytes in data_, which may have been damaged.
  Decoded decode(const std::uint32_t* available = nullptr, std::uint32_t first = 0) {
    const PackedHeader& header = grid_.packed()->header();
    std::vector<decode_detail::Quad> copy((data_.size() + 15) / 16);  // at a multiple of 16, as on the device
    std::memcpy(copy.data(), data_.data(), data_.size());
    Decoded decoded;
    decoded.values.resize(blocks_.size());
    std::vector<decode_detail::BlockTask> tasks(blocks_.size());
    std::vector<std::uint32_t> order(blocks_.size());
    std::vector<std::uint32_t> overflown(blocks_.size());
    std::vector<decode_detail::Quad> tables(decode_detail::SharedTables::kBytes / sizeof(decode_detail::Quad));
    decode_detail::CallCounts counts;
    std::array<std::uint32_t, 2> totals{};
    DecodeCall call;
    call.view.data = reinterpret_cast<const std::byte*>(copy.data());
    call.view.bytes = data_.size();
    call.view.table = header.table;
    call.view.regions = static_cast<std::uint64_t>(header.regions.size());
    call.view.constants = header.constants();
    call.tables = reinterpret_cast<const unsigned char*>(tables.data());
    call.blocks = blocks_.data();
    call.most = static_cast<std::uint32_t>(blocks_.size());
    call.available = available;
    call.first = first;
    call.values = decoded.values.data()->of;
    call.tasks = tasks.data();
    call.order = order.data();
    call.overflown = overflown.data();
    call.counts = &counts;
    call.totals = totals.data();
    run(call, reinterpret_cast<unsigned char*>(tables.data()));
    decoded.damaged = totals[0];
    decoded.wide = totals[1];
    return decoded;
  }

  // Runs one step after the other, as kernels run.
  static void run(const DecodeCall& call, unsigned char* tables) {
    const std::size_t bytes = std::max(magnitude_bytes<std::uint32_t>(kThreads),
                                       static_cast<unsigned>(kThreads / kWarp * kStageWords * sizeof(float)));
    const auto shared = std::make_unique<std::max_align_t[]>(bytes / sizeof(std::max_align_t) + 1);
    auto* memory = reinterpret_cast<unsigned char*>(shared.get());
    const auto bins = std::make_unique<std::uint32_t[]>(std::size_t{2} * decode_detail::kBins);
    Group group;
    std::vector<std::jthread> threads;
    for (unsigned i = 0; i < kThreads; ++i) {
      threads.emplace_back([&, i] {
        const HostThread thread(group, i);
        void* stage = memory + i / kWarp * kStageWords * sizeof(float);
        decode_detail::SharedTables(tables).fill(thread, kBlockScan, call.view.constants.tables);
        look_at_blocks(thread, call, bins.get());
        thread.meet();
        order_blocks(thread, call, bins.get());
        thread.meet();
        take_magnitudes<std::uint16_t>(thread, call, kScanSteps, memory);
        thread.meet();
        make_values<std::uint16_t>(thread, call, kBlockScan, kDiagonals, stage);
        thread.meet();
        take_magnitudes<std::uint32_t>(thread, call, kScanSteps, memory);
        thread.meet();
        make_values<std::uint32_t>(thread, call, kBlockScan, kDiagonals, stage);
      });
    }
  }

  // Sets the values that file readers get. Returns the kind of the block's stream.
  std::string expect(BlockId id, std::array<float, 512>& values) const {
    const PackedData& packed = *grid_.packed();
    const PackedRegion region = packed.region(packed.regions().position(static_cast<std::int64_t>(id >> 12U)));
    values.fill(region.value);
    if (region.chunk == 0) return "none";
    const PackedStream stream = packed.stream(region, static_cast<unsigned>(id & 4095U));
    if (stream.data == nullptr) return "none";
    packed.decode(stream, values);
    const auto head = static_cast<unsigned>(stream.data[0]);
    switch (static_cast<PackedKind>(head & 3U)) {
      case PackedKind::mean:
        return "mean";
      case PackedKind::transform:
        return "transform";
      case PackedKind::raw:
        return "raw";
      case PackedKind::lattice:
        break;
    }
    const bool ordered = static_cast<LatticeKind>(head >> 4U & 3U) == LatticeKind::ordered;
    return (ordered ? "ordered lattice " : "own lattice ") + std::to_string(head >> 2U & 3U);
  }

  static std::vector<std::byte> bytes_of(const NvdbGrid& grid) {
    const std::span<const std::byte> bytes = grid.packed()->bytes();
    return {bytes.begin(), bytes.end()};
  }

  test::PackedFile file_;
  NvdbGrid grid_;
  std::vector<std::byte> data_;
  std::vector<BlockId> blocks_;
};

TEST_F(DecodeSteps, GiveTheBitsThatReadersOfFilesGet) {
  const Decoded decoded = decode();
  EXPECT_EQ(decoded.damaged, 0U);
  std::map<std::string, int> kinds;
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    std::array<float, 512> expected;
    kinds[expect(blocks_[i], expected)] += 1;
    ASSERT_EQ(std::memcmp(expected.data(), decoded.values[i].of, sizeof expected), 0) << i;
  }
  EXPECT_GT(kinds["none"], 100);
  EXPECT_GT(kinds["mean"], 5);
  EXPECT_GT(kinds["raw"], 5);
  EXPECT_GT(kinds["transform"], 100);
  for (const std::string kind : {"own lattice ", "ordered lattice "}) {
    for (unsigned predictor = 0; predictor < kPredictors; ++predictor) {
      EXPECT_GT(kinds[kind + std::to_string(predictor)], 0) << kind << predictor;
    }
  }
  EXPECT_GT(decoded.wide, 5U);
  EXPECT_LT(decoded.wide, static_cast<unsigned>(kinds["transform"]) / 2);
}

TEST_F(DecodeSteps, TakeNoMoreBlocksThanThereAre) {
  blocks_.resize(200);
  const Decoded all = decode();
  const std::uint32_t available = 150;
  const Decoded some = decode(&available, 50);
  const std::array<float, 512> untouched{};
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    const float* expected = i < 100 ? all.values[i].of : untouched.data();
    EXPECT_EQ(std::memcmp(expected, some.values[i].of, sizeof untouched), 0) << i;
  }
  EXPECT_EQ(decode(&available, 151).values[0].of[0], 0);
}

// For any bytes, a block is either NaN and counted, or has some values. A sanitizer reports reads outside the data.
TEST_F(DecodeSteps, DamagedBytesAreCounted) {
  std::mt19937 random(5);
  const std::vector<std::byte> whole = data_;
  std::uint32_t damaged = 0;
  for (int trial = 0; trial < (kSanitized ? 2 : 8); ++trial) {
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
  EXPECT_GT(damaged, kSanitized ? 15U : 60U);
}

TEST_F(DecodeSteps, ABlockOutsideTheGridIsDamaged) {
  blocks_ = {static_cast<BlockId>(grid_.packed()->regions().size()) << 12U};
  const Decoded decoded = decode();
  EXPECT_EQ(decoded.damaged, 1U);
  EXPECT_TRUE(std::isnan(decoded.values[0].of[511]));
}

}  // namespace
}  // namespace weir::decode_steps_test
