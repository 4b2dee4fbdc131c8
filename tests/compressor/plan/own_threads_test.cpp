// The threads of a conversion in a program that has used oneTBB in another floating-point mode.
#include "compressor/plan/own_threads.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <cfenv>
#include <thread>
#include <vector>

#include "format/base/error.h"
#include "ingest/values/array_source.h"
#include "tests/compressor/support/converted.h"
#include "tests/support/message_of_error.h"

namespace weir::own_threads_test {
namespace {

// Calls work() on a thread that rounds upwards and has used oneTBB in that mode. Expects that the thread still rounds
// upwards afterwards.
template <typename Work>
void rounding_upwards(const Work& work) {
  std::jthread([&] {
    ASSERT_EQ(std::fesetround(FE_UPWARD), 0);
    tbb::parallel_for(0, 1000, [](int) {});
    work();
    EXPECT_EQ(std::fegetround(), FE_UPWARD);
  });
}

TEST(OwnThreads, RoundToNearestWhateverTheCallersLoopsDo) {
  rounding_upwards([] {
    OwnThreads threads(2);
    std::atomic<int> nearest{0};
    threads.run(
        [&] { tbb::parallel_for(0, 1000, [&](int) { nearest += std::fegetround() == FE_TONEAREST ? 1 : 0; }); });
    EXPECT_EQ(nearest, 1000);
  });
}

TEST(OwnThreads, ResultAndErrorsComeFromTheWork) {
  EXPECT_EQ(OwnThreads(1).run([] { return 7; }), 7);
  EXPECT_EQ(message_of_error(ErrorKind::budget,
                             [] { OwnThreads(2).run([] { throw Error(ErrorKind::budget, "it does not fit"); }); }),
            "it does not fit");
}

TEST(OwnThreads, ConversionRoundsToNearestWhateverTheCallersLoopsDo) {
  constexpr std::int64_t kEdge = 40;
  std::vector<float> values;
  for (int i = 0; i < kEdge * kEdge * kEdge; ++i) values.push_back(static_cast<float>((i * 0.37) - (i % 1009) * 0.013));
  DenseArray array;
  array.data = values.data();
  array.extent = {kEdge, kEdge, kEdge};
  array.stride = packed_stride(array.extent, array.type);
  const auto converted = [&](const Budget& budget, Encoding encoding) {
    const auto source = open_array(array);
    ConversionOptions options;
    options.encoding = encoding;
    options.budget = budget;
    options.threads = 2;
    return test::convert(*source, options).file;
  };
  for (const Budget& budget : {Budget{Budget::Kind::rate, 8}, Budget{Budget::Kind::psnr, 8, 0, 60},
                               Budget{Budget::Kind::max_error, 8, 0, 0.5}}) {
    const std::vector<std::byte> expected = converted(budget, Encoding::packed);
    rounding_upwards(
        [&] { EXPECT_TRUE(converted(budget, Encoding::packed) == expected) << static_cast<int>(budget.kind); });
  }
}

}  // namespace
}  // namespace weir::own_threads_test
