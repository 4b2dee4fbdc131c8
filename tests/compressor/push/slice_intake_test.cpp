#include "compressor/push/slice_intake.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <functional>
#include <future>
#include <map>
#include <mutex>
#include <numeric>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "format/base/error.h"
#include "format/process/fault.h"
#include "tests/compressor/support/failing_allocation.h"

namespace weir::slice_intake_test {
namespace {

using namespace std::chrono_literals;

// Two slices per layer; the last layer has two planes. The 16-bit values are the voxels' linear indices.
constexpr Box kDomain{{0, 0, 0}, {20, 30, 42}};
constexpr std::int64_t kSlices = 12;

BlockPlan plan() {
  BlockPlan plan;
  plan.lattice = make_lattice(kDomain, kLeafDim);
  plan.leaves = {3, 2, 1};
  plan.count = {1, 2, 6};
  return plan;
}

std::vector<std::uint16_t> volume_values() {
  std::vector<std::uint16_t> values;
  for_each_index(kDomain, [&](const Index3& i) {
    values.push_back(static_cast<std::uint16_t>(linear_index(i, kDomain.extent())));
  });
  return values;
}

std::vector<std::uint16_t> expected_slice(std::int64_t slice) {
  std::vector<std::uint16_t> values;
  for_each_index(plan().voxel_box(plan().leaf_box(slice)), [&](const Index3& i) {
    values.push_back(static_cast<std::uint16_t>(linear_index(i, kDomain.extent())));
  });
  return values;
}

// Keeps the values that it is given. Calls `before` before it keeps anything.
class Keeper {
 public:
  SliceSink sink() {
    return {[this](std::int64_t slice, PlaneMask parked, std::span<std::byte> values) {
              before("complete", slice);
              const std::lock_guard lock(mutex_);
              copy_planes(slice, parked, parked_[slice], values);
              auto& kept = complete_[slice];
              EXPECT_TRUE(kept.empty()) << "slice " << slice << " came twice";
              kept.resize(values.size() / 2);
              std::memcpy(kept.data(), values.data(), values.size());
            },
            [this](std::int64_t slice, PlaneMask planes, std::span<const std::byte> values) {
              before("park", slice);
              const std::lock_guard lock(mutex_);
              parked_[slice].resize(values.size());
              copy_planes(slice, planes, values, parked_[slice]);
              parkings.push_back(slice);
            },
            [this] { ++abandoned; }};
  }

  void expect_all() const {
    ASSERT_EQ(std::ssize(complete_), kSlices);
    for (const auto& [slice, values] : complete_) EXPECT_EQ(values, expected_slice(slice)) << slice;
  }

  std::function<void(const std::string& what, std::int64_t slice)> before = [](const std::string&, std::int64_t) {};
  std::vector<std::int64_t> parkings;
  std::atomic<int> abandoned{0};

 private:
  static void copy_planes(std::int64_t slice, PlaneMask planes, std::span<const std::byte> from,
                          std::span<std::byte> to) {
    const Index3 extent = plan().voxel_box(plan().leaf_box(slice)).extent();
    const auto plane = static_cast<std::size_t>(extent.x * extent.y) * 2;
    for (std::size_t i = 0; i * plane < to.size(); ++i) {
      if ((planes >> i & 1) != 0) std::memcpy(&to[i * plane], &from[i * plane], plane);
    }
  }

  std::mutex mutex_;
  std::map<std::int64_t, std::vector<std::uint16_t>> complete_;
  std::map<std::int64_t, std::vector<std::byte>> parked_;
};

class SliceIntakeTest : public testing::Test {
 protected:
  StridedVoxels slab(std::int64_t z0, std::int64_t nz) const {
    const Box box{{0, 0, z0}, {20, 30, z0 + nz}};
    return {box, reinterpret_cast<const std::byte*>(&values_[static_cast<std::size_t>(z0) * 600]), {2, 40, 1200}, 2};
  }

  std::vector<std::int64_t> shuffled_planes() const {
    std::vector<std::int64_t> planes(42);
    std::iota(planes.begin(), planes.end(), 0);
    std::ranges::shuffle(planes, std::mt19937(4));
    return planes;
  }

  template <typename Call>
  static std::string message_of(const Call& call) {
    try {
      call();
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }

  std::vector<std::uint16_t> values_ = volume_values();
  Keeper keeper_;
};

TEST_F(SliceIntakeTest, HandsOverEverySliceOnce) {
  for (const std::size_t buffers : {1U, 2U, 5U, 12U}) {
    for (const std::size_t workers : {1U, 3U}) {
      Keeper keeper;
      SliceIntake intake(plan(), 2, {buffers, workers}, keeper.sink());
      for (const std::int64_t z : shuffled_planes()) intake.add(slab(z, 1));
      intake.finish();
      keeper.expect_all();
      EXPECT_EQ(keeper.parkings.empty(), buffers == 12);
      EXPECT_EQ(keeper.abandoned, 0);
    }
  }
}

TEST_F(SliceIntakeTest, TakesSlabsFromManyThreads) {
  for (const std::size_t buffers : {2U, 12U}) {
    Keeper keeper;
    SliceIntake intake(plan(), 2, {buffers, 2}, keeper.sink());
    const std::vector<std::int64_t> planes = shuffled_planes();
    std::atomic<std::size_t> next{0};
    {
      std::vector<std::jthread> threads;
      for (int t = 0; t < 4; ++t) {
        threads.emplace_back([&] {
          for (std::size_t i = next++; i < planes.size(); i = next++) intake.add(slab(planes[i], 1));
        });
      }
    }
    intake.finish();
    keeper.expect_all();
  }
}

TEST_F(SliceIntakeTest, ParksTheLeastRecentlyUsedSlices) {
  SliceIntake intake(plan(), 2, {4, 1}, keeper_.sink());
  intake.add(slab(0, 1));   // slices 0 and 1
  intake.add(slab(8, 1));   // 2 and 3
  intake.add(slab(1, 1));   // 0 and 1 again
  intake.add(slab(16, 1));  // 4 and 5 replace 2 and 3
  intake.add(slab(2, 6));   // 0 and 1 are complete
  intake.add(slab(9, 7));
  intake.add(slab(17, 25));
  intake.finish();
  EXPECT_EQ(keeper_.parkings, (std::vector<std::int64_t>{2, 3}));
  keeper_.expect_all();
}

TEST_F(SliceIntakeTest, WaitsForAWorkerThatMakesRoom) {
  std::promise<void> open;
  const std::shared_future<void> opened(open.get_future());
  std::atomic<int> begun{0};
  keeper_.before = [&](const std::string&, std::int64_t) {
    ++begun;
    opened.wait();
  };
  SliceIntake intake(plan(), 2, {3, 1}, keeper_.sink());
  intake.add(slab(0, 8));  // takes two of three buffers
  auto adding = std::async(std::launch::async, [&] { intake.add(slab(8, 34)); });
  EXPECT_EQ(adding.wait_for(50ms), std::future_status::timeout);
  EXPECT_EQ(begun, 1);
  open.set_value();
  adding.get();
  intake.finish();
  keeper_.expect_all();
}

TEST_F(SliceIntakeTest, EndsWithTheFirstErrorOfItsSink) {
  for (const std::string failing : {"complete", "park"}) {
    for (const std::size_t workers : {1U, 3U}) {
      Keeper keeper;
      std::atomic<int> calls{0};
      keeper.before = [&](const std::string& what, std::int64_t) {
        if (what == failing && ++calls == 3) throw Error(ErrorKind::io, "the disk is full");
      };
      SliceIntake intake(plan(), 2, {2, workers}, keeper.sink());
      // All threads that wait get the error.
      const std::vector<std::int64_t> planes = shuffled_planes();
      std::atomic<std::size_t> next{0};
      std::atomic<int> refused{0};
      {
        std::vector<std::jthread> threads;
        for (int t = 0; t < 3; ++t) {
          threads.emplace_back([&] {
            for (std::size_t i = next++; i < planes.size(); i = next++) {
              const std::string message = message_of([&] { intake.add(slab(planes[i], 1)); });
              if (message == "no error") continue;
              EXPECT_EQ(message, "the disk is full");
              EXPECT_EQ(keeper.abandoned, 1);
              ++refused;
              return;
            }
          });
        }
      }
      EXPECT_EQ(message_of([&] { intake.finish(); }), "the disk is full");
      EXPECT_EQ(message_of([&] { intake.check(); }), "the disk is full");
      EXPECT_STREQ(intake.fail({ErrorKind::interrupted, "another"}).what(), "the disk is full");
      EXPECT_EQ(keeper.abandoned, 1);
    }
  }
}

TEST_F(SliceIntakeTest, ReportsOtherExceptionsOfItsSink) {
  keeper_.before = [](const std::string&, std::int64_t) { throw std::bad_alloc(); };
  SliceIntake intake(plan(), 2, {12, 1}, keeper_.sink());
  const auto both = [&] {
    intake.add(slab(0, 8));  // already throws if a worker was quick
    intake.finish();
  };
  EXPECT_EQ(message_of(both), fault_of(std::bad_alloc()).what());
}

// The planes of the slab count as given. If the intake did not end, the volume would lack them without an error.
TEST_F(SliceIntakeTest, SlabThatFindsNoMemory_EndsTheIntake) {
  bool taken = false;
  for (int before = 0; !taken; ++before) {
    Keeper keeper;
    SliceIntake intake(plan(), 2, {12, 1}, keeper.sink());
    const std::string message = [&] {
      const FailingAllocation failing(before);
      return message_of([&] { intake.add(slab(0, 12)); });
    }();
    taken = message == "no error";
    if (taken) break;
    EXPECT_EQ(message, fault_of(std::bad_alloc()).what()) << before;
    EXPECT_EQ(message_of([&] { intake.check(); }), message) << before;
    EXPECT_EQ(message_of([&] { intake.finish(); }), message) << before;
    ASSERT_LT(before, 1000);
  }
}

TEST_F(SliceIntakeTest, FailFromOutsideRefusesFurtherSlabs) {
  SliceIntake intake(plan(), 2, {12, 2}, keeper_.sink());
  intake.add(slab(0, 8));
  EXPECT_STREQ(intake.fail({ErrorKind::interrupted, "enough"}).what(), "enough");
  EXPECT_EQ(keeper_.abandoned, 1);
  EXPECT_EQ(message_of([&] { intake.add(slab(8, 1)); }), "enough");
}

// A thread that waits for such an intake would wait forever.
TEST_F(SliceIntakeTest, NeedsBuffersAndWorkers) {
  for (const IntakeRoom room : {IntakeRoom{0, 1}, IntakeRoom{1, 0}}) {
    EXPECT_EQ(message_of([&] { const SliceIntake intake(plan(), 2, room, keeper_.sink()); }),
              "a slice intake without buffers or workers");
  }
  EXPECT_EQ(keeper_.abandoned, 0);
}

TEST_F(SliceIntakeTest, CanBeDestroyedUnfinished) {
  const SliceIntake never(plan(), 2, {12, 2}, keeper_.sink());
  SliceIntake intake(plan(), 2, {12, 2}, keeper_.sink());
  intake.add(slab(0, 20));
  EXPECT_EQ(keeper_.abandoned, 0);
}

}  // namespace
}  // namespace weir::slice_intake_test
