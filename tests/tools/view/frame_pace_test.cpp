#include "tools/view/frame_pace.h"

#include <gtest/gtest.h>

namespace weir::frame_pace_test {
namespace {

/// Returns the pace after `frames` pictures of a machine that takes `sample_s` per pixel sample and `fixed_s` per
/// picture.
FramePace settled(double sample_s, double fixed_s, int frames = 30, int viewers = 1) {
  FramePace pace;
  for (int i = 0; i < frames; ++i) {
    const FrameSize size = pace.next(800, 600, 1, viewers);
    const auto samples =
        static_cast<std::uint64_t>(size.width) * static_cast<std::uint64_t>(size.height) * size.samples;
    pace.add(samples, fixed_s + sample_s * static_cast<double>(samples));
  }
  return pace;
}

double seconds(const FrameSize& size, double sample_s) { return size.width * size.height * size.samples * sample_s; }

TEST(FramePace, SlowMachine_GetsSmallPicturesInTime) {
  const FrameSize size = settled(1e-6, 0).next(800, 600, 1, 1);
  EXPECT_LE(seconds(size, 1e-6), FramePace::kFrame_s);
  EXPECT_GT(seconds(size, 1e-6), 0.5 * FramePace::kFrame_s);
  EXPECT_EQ(size.samples, 1U);
  EXPECT_NEAR(static_cast<double>(size.width) / size.height, 800.0 / 600, 0.02);
}

TEST(FramePace, FastMachine_GetsWholePicturesWithMoreSamples) {
  EXPECT_EQ(settled(1e-9, 0).next(800, 600, 1, 1), (FrameSize{800, 600, FramePace::kMostSamples}));
}

TEST(FramePace, FixedCosts_AreCounted) {
  const FrameSize size = settled(1e-7, 0.02, 60).next(800, 600, 1, 1);
  EXPECT_LE(0.02 + seconds(size, 1e-7), 1.1 * FramePace::kFrame_s);
}

TEST(FramePace, PicturesAreNotSmallerThanATenth) {
  EXPECT_EQ(settled(5e-5, 0).next(800, 600, 1, 1), (FrameSize{80, 60, 1}));
}

TEST(FramePace, PicturesThatWouldTakeLong_AreSmallerThanATenth) {
  const FrameSize size = settled(1e-3, 0).next(800, 600, 1, 1);
  EXPECT_LE(seconds(size, 1e-3), FramePace::kLongest_s);
  EXPECT_GT(seconds(size, 1e-3), 0.5 * FramePace::kLongest_s);
  EXPECT_EQ(settled(1, 0).next(800, 600, 1, 1), (FrameSize{8, 6, 1}));
}

TEST(FramePace, TwoViewers_ShareTheTime) {
  const FramePace pace = settled(1e-6, 0);
  EXPECT_LE(seconds(pace.next(800, 600, 1, 2), 1e-6), FramePace::kFrame_s / 2);
}

TEST(FramePace, TwoLayers_ShareTheTime) {
  const FramePace pace = settled(1e-6, 0);
  EXPECT_LE(2 * seconds(pace.next(800, 600, 2, 1), 1e-6), FramePace::kFrame_s);
}

TEST(FramePace, ADearerMode_IsBelievedAtOnce) {
  FramePace pace = settled(1e-7, 0);
  pace.add(100'000, 1);
  EXPECT_LE(seconds(pace.next(800, 600, 1, 1), 1e-5), FramePace::kFrame_s);
}

TEST(FramePace, NothingMeasured_ChangesNothing) {
  FramePace pace;
  const FrameSize before = pace.next(800, 600, 1, 1);
  pace.add(0, 1);
  pace.add(1000, 0);
  EXPECT_EQ(pace.next(800, 600, 1, 1), before);
}

}  // namespace
}  // namespace weir::frame_pace_test
