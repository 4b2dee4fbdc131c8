// What a brick cache does when the device refuses memory, when it is made and in the middle of paging, on the pretended
// device: it gets smaller, or the refusal is an error that leaves nothing behind and after which the next try works.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "format/nanovdb/nvdb_grid.h"
#include "gpu/cuda/bricks/brick_cache.h"
#include "gpu/math/narrow.h"
#include "tests/fake_cuda/fake_array.h"
#include "tests/fake_cuda/fake_runtime.h"
#include "tests/gpu/bricks/host_machine.h"
#include "tests/support/packed_grid.h"

namespace weir::brick_cache_fault_test {
namespace {

using test::FakeRuntime;
using Sampler = PagedSampler<Filter::nearest, Noting::inlined>;

constexpr std::int32_t kEdge = 32;  // blocks
constexpr std::uint64_t kMiB = std::uint64_t{1} << 20U;
constexpr std::uint64_t kBudget = 24 * kMiB;       // holds half of the bricks with 16 bits
constexpr std::uint64_t kFloatBudget = 44 * kMiB;  // three quarters of it would hold some thousand floats, too

// Of the voxels of a block: no two next to each other have the same.
float value_of(const Int3& block) {
  return static_cast<float>((block.x * 7 + block.y * 5 + block.z * 3) % 64) + static_cast<float>(block.x) / 64;
}

class BrickCacheFault : public testing::Test {
 protected:
  BrickCacheFault() { runtime().reset(); }
  ~BrickCacheFault() override {
    runtime().heal();
    EXPECT_EQ(runtime().allocated_bytes(), 0U);
    runtime().reset();
  }

  static FakeRuntime& runtime() { return FakeRuntime::instance(); }

  // Of 256^3 voxels, or of 176^3; where `odd`, one of them is no finite number, which 16 bits do not hold.
  static const NvdbGrid& grid(bool odd = false, bool small = false) {
    struct Made {
      Made(bool odd, std::int64_t edge) {
        test::PackedGridOptions options;
        options.domain = {{0, 0, 0}, {8 * edge, 8 * edge, 8 * edge}};
        options.stream = [odd](const Index3& block) {
          const float value = value_of(narrow(block));
          if (!odd || block != kOdd) return test::constant_stream(value);
          std::array<float, 512> values;
          values.fill(value);
          values[77] = std::numeric_limits<float>::infinity();  // in no other block's brick
          return test::raw_stream(values);
        };
        file = test::PackedGridBuilder::build(options);
        grid = std::make_unique<NvdbGrid>(NvdbGrid::open(file.file, "a.nvdb"));
      }
      test::PackedFile file;
      std::unique_ptr<NvdbGrid> grid;
    };
    static const Made plain(false, kEdge);
    static const Made with_odd(true, kEdge);
    static const Made small_with_odd(true, 22);
    return small ? *small_with_odd.grid : odd ? *with_odd.grid : *plain.grid;
  }

  static std::unique_ptr<BrickCache> make(const NvdbGrid& grid, std::uint64_t bytes,
                                          BricksKept kept = BricksKept::some) {
    return std::make_unique<BrickCache>(std::make_unique<test::HostPackedSource>(*grid.packed(), grid.index_bbox()),
                                        BrickBudget{.bytes = bytes}, kept);
  }

  static std::vector<Int3> stretch(std::int32_t x, std::int32_t count) {
    std::vector<Int3> blocks;
    for (std::int32_t i = 0; i < count; ++i) blocks.push_back({x + i / (kEdge * kEdge), i / kEdge % kEdge, i % kEdge});
    return blocks;
  }

  // The texels at a brick's eight corners are voxels of the eight blocks there.
  static void expect_right(const BrickCache& cache, const Sampler& seen, const BrickEntry& entry, const Int3& block) {
    const test::FakeArray& texels = test::array_of(seen.texture);
    for (std::int32_t k = 0; k < 8; ++k) {
      const Int3 above{k & 1, k >> 1 & 1, k >> 2};
      const Int3 corner = entry.corner();
      const Int3 at{corner.x + 8 * above.x, corner.y + 8 * above.y, corner.z + 8 * above.z};
      const auto beside = [](std::int32_t b, std::int32_t step) { return std::min(b + step, kEdge - 1); };
      const float expected = value_of({beside(block.x, above.x), beside(block.y, above.y), beside(block.z, above.z)});
      if (cache.texel_type() == TexelType::float32) {
        ASSERT_EQ(texels.read<float>(at), expected);
      } else {
        const float texel = static_cast<float>(texels.read<unsigned short>(at)) / kMostTexel;
        ASSERT_NEAR(entry.low + entry.span * texel, expected, 1e-3);
      }
    }
  }

  // Looks blocks up until all of them are there and right, turn after turn; false where they do not come.
  static bool come(BrickCache& cache, const std::vector<Int3>& blocks, std::uint64_t* evicted = nullptr) {
    for (int turn = 0; turn < 20; ++turn) {
      const auto seen = cache.paged_sampler<Sampler>();
      std::size_t found = 0;
      for (const Int3& block : blocks) {
        const BrickEntry entry = seen.table.pages.find_or_request(block);
        if ((entry.state & brick_state::kMissing) != 0) continue;
        expect_right(cache, seen, entry, block);
        ++found;
      }
      if (found == blocks.size()) return true;
      const PagingTurn served = cache.serve();
      if (evicted != nullptr) *evicted += served.evicted;
    }
    return false;
  }

  static constexpr Index3 kOdd{9, 4, 5};
};

std::string message_of(const DeviceFull& refused) { return refused.what(); }

const std::string kRefused = ": cudaErrorMemoryAllocation, pretended";

TEST_F(BrickCacheFault, MadeWhereOneAllocationIsRefused_IsSmallerAndDrawsTheSame) {
  const auto whole = make(grid(), kBudget);
  EXPECT_TRUE(whole->paged());
  EXPECT_EQ(whole->refusal(), "");
  const std::uint64_t allocations = runtime().calls("allocation");
  ASSERT_GT(allocations, 30U);
  const std::vector<Int3> blocks = stretch(3, 4000);
  int smaller = 0;
  for (std::uint64_t n = 0; n < allocations; ++n) {
    runtime().fail("allocation", static_cast<int>(n), cudaErrorMemoryAllocation);
    const auto cache = make(grid(), kBudget);
    if (cache->refusal().empty()) {
      EXPECT_EQ(cache->bricks(), whole->bricks()) << "the texture alone is tried twice";
    } else {
      EXPECT_NE(cache->refusal().find(kRefused), std::string::npos) << cache->refusal();
      EXPECT_LT(cache->bricks(), whole->bricks());
      EXPECT_LE(cache->bytes(), kBudget * 3 / 4);
      ++smaller;
    }
    if (n % 8 == 0) {
      EXPECT_TRUE(come(*cache, blocks)) << n;
    }
  }
  EXPECT_EQ(smaller, static_cast<int>(allocations) - 1);
}

TEST_F(BrickCacheFault, MadeWhereAllFurtherAllocationsAreRefused_IsAnErrorThatLeavesNothing) {
  make(grid(), kBudget);
  const std::uint64_t allocations = runtime().calls("allocation");
  for (std::uint64_t n = 0; n < allocations; ++n) {
    runtime().fail_from("allocation", static_cast<int>(n), cudaErrorMemoryAllocation);
    try {
      make(grid(), kBudget);
      FAIL() << n;
    } catch (const DeviceFull& refused) {
      EXPECT_NE(message_of(refused).find(kRefused), std::string::npos) << message_of(refused);
      EXPECT_EQ(refused.kind(), ErrorKind::io);
    }
    EXPECT_EQ(runtime().allocated_bytes(), 0U) << n;
    runtime().heal();
  }
  EXPECT_TRUE(come(*make(grid(), kBudget), stretch(0, 3000)));
}

TEST_F(BrickCacheFault, OfADeviceWithLessThanTheBudget_TakesWhatThereIs) {
  runtime().set_capacity(60 * kMiB);
  const auto cache = make(grid(), 400 * kMiB);
  EXPECT_FALSE(cache->paged()) << "all bricks fit";
  runtime().set_capacity(cache->bytes() + 30 * kMiB);
  const auto less = make(grid(), 400 * kMiB);
  EXPECT_TRUE(less->paged());
  EXPECT_LT(less->bytes(), 30 * kMiB);
  EXPECT_NE(less->refusal().find(kRefused), std::string::npos) << less->refusal();
  EXPECT_TRUE(come(*less, stretch(0, 4000)));
  EXPECT_THROW(make(grid(), 400 * kMiB, BricksKept::all), Error);
}

// A brick that 16 bits do not hold is met in the middle of a picture: all is made again with floats.
TEST_F(BrickCacheFault, MadeAgainWhereOneAllocationIsRefused_IsSmallerOrComesBackWithTheNextPicture) {
  const std::vector<Int3> blocks = stretch(8, 3000);
  const auto cache = make(grid(true), kFloatBudget);
  ASSERT_TRUE(cache->paged());
  const std::uint64_t before = runtime().calls("allocation");
  EXPECT_TRUE(come(*cache, blocks));
  EXPECT_EQ(cache->texel_type(), TexelType::float32);
  const std::uint64_t bricks = cache->bricks();
  const std::uint64_t allocations = runtime().calls("allocation") - before;
  ASSERT_GT(allocations, 30U);
  for (std::uint64_t n = 0; n < allocations; ++n) {
    const auto again = make(grid(true), kFloatBudget);
    ASSERT_EQ(again->texel_type(), TexelType::share16);
    runtime().fail("allocation", static_cast<int>(n), cudaErrorMemoryAllocation);
    EXPECT_TRUE(come(*again, blocks)) << n;
    EXPECT_EQ(again->texel_type(), TexelType::float32);
    EXPECT_EQ(again->bricks() < bricks, !again->refusal().empty()) << n;
    runtime().heal();
  }
}

TEST_F(BrickCacheFault, MadeAgainWhereAllAllocationsAreRefused_IsAnErrorAndComesBackWithTheNextPicture) {
  const std::vector<Int3> blocks = stretch(8, 3000);
  for (int n = 0; n <= 30; n += 3) {
    const auto cache = make(grid(true), kFloatBudget);
    runtime().fail_from("allocation", n, cudaErrorMemoryAllocation);
    EXPECT_THROW(come(*cache, blocks), DeviceFull);
    EXPECT_EQ(runtime().allocated_bytes(), 0U) << "it holds nothing";
    EXPECT_THROW(cache->restore(), DeviceFull) << "as long as there is nothing to have";
    runtime().heal();
    cache->restore();
    EXPECT_TRUE(come(*cache, blocks));
    EXPECT_EQ(cache->texel_type(), TexelType::float32);
    EXPECT_EQ(cache->refusal(), "") << "it is as large as it was meant to be";
  }
}

// 16 bits do not hold all, and of what the device has left, floats need more: it is the device that has too little.
TEST_F(BrickCacheFault, MadeSmallerThanFloatsNeed_SaysWhatTheDeviceHasRefused) {
  runtime().fail("allocation", 5, cudaErrorMemoryAllocation);
  const auto cache = make(grid(true, true), 32 * kMiB);
  EXPECT_LT(cache->bytes(), 24 * kMiB);
  try {
    come(*cache, {narrow(kOdd)});
    FAIL();
  } catch (const DeviceFull& refused) {
    EXPECT_EQ(std::string(refused.what()), cache->refusal());
    EXPECT_NE(cache->refusal().find(kRefused), std::string::npos) << cache->refusal();
  }
}

TEST_F(BrickCacheFault, AKernelThatIsRefusedMemoryInTheMiddleOfATurn_LeavesNoWrongBricks) {
  const std::vector<Int3> blocks = stretch(2, 2000);
  const auto cache = make(grid(), kBudget);
  for (int n = 0; n < 12; ++n) {
    runtime().fail("launch", n, cudaErrorMemoryAllocation);
    EXPECT_THROW(come(*cache, stretch(10, 2000)), DeviceFull) << n;
    runtime().heal();
    cache->restore();
    EXPECT_TRUE(come(*cache, blocks));
  }
}

TEST_F(BrickCacheFault, Shrunk_GivesBackWhatIsAskedForUntilItWouldHoldTooLittle) {
  const auto cache = make(grid(), kFloatBudget);
  std::uint64_t bytes = cache->bytes();
  EXPECT_FALSE(cache->shrink(30 * kMiB, "a picture"));
  EXPECT_EQ(cache->bytes(), bytes);
  EXPECT_EQ(cache->refusal(), "");
  int times = 0;
  while (cache->shrink(3 * kMiB, "a picture")) {
    EXPECT_LE(cache->bytes(), bytes - 3 * kMiB);
    EXPECT_EQ(cache->refusal(), "a picture");
    bytes = cache->bytes();
    ++times;
    EXPECT_TRUE(come(*cache, stretch(times, 3000)));
  }
  EXPECT_GE(times, 3);
  EXPECT_LT(bytes, 24 * kMiB);
  EXPECT_FALSE(make(grid(), 100 * kMiB, BricksKept::all)->shrink(1, "a picture"));
}

// One that holds all bricks has less than its budget: what it really holds shrinks.
TEST_F(BrickCacheFault, ShrunkFromAllBricks_HoldsSome) {
  const auto cache = make(grid(), 400 * kMiB);
  ASSERT_FALSE(cache->paged());
  const std::uint64_t bytes = cache->bytes();
  ASSERT_TRUE(cache->shrink(kMiB, "a picture"));
  EXPECT_TRUE(cache->paged());
  EXPECT_LE(cache->bytes(), bytes * 7 / 8);
  EXPECT_TRUE(come(*cache, stretch(0, 4000)));
}

TEST_F(BrickCacheFault, AThousandEvictionsAndAsManyCaches_LeaveNothing) {
  const auto cache = make(grid(), kBudget);
  const std::uint64_t held = runtime().allocated_bytes();
  const std::uint64_t allocations = runtime().calls("allocation");
  std::uint64_t evicted = 0;
  EXPECT_TRUE(come(*cache, stretch(0, 10000), &evicted));
  EXPECT_EQ(evicted, 0U);
  EXPECT_TRUE(come(*cache, stretch(16, 10000), &evicted));
  EXPECT_EQ(evicted, 20000 - cache->bricks()) << "no more than have to go";
  EXPECT_TRUE(come(*cache, stretch(4, 10000), &evicted));
  EXPECT_GT(evicted, 10000U);
  EXPECT_EQ(runtime().allocated_bytes(), held);
  EXPECT_EQ(runtime().calls("allocation"), allocations) << "paging allocates nothing";

  test::PackedGridOptions small;
  small.domain = {{0, 0, 0}, {24, 16, 16}};
  small.stream = [](const Index3& block) { return test::constant_stream(value_of(narrow(block))); };
  const test::PackedFile file = test::PackedGridBuilder::build(small);
  const NvdbGrid small_grid = NvdbGrid::open(file.file, "a.nvdb");
  for (int n = 0; n < 1000; ++n) {
    const auto one = make(small_grid, kBudget);
    ASSERT_FALSE(one->paged());
    ASSERT_GT(runtime().allocated_bytes(), held);
  }
  EXPECT_EQ(runtime().allocated_bytes(), held);
}

}  // namespace
}  // namespace weir::brick_cache_fault_test
