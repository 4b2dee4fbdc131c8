#include "gpu/render/playback.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <fstream>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "format/base/error.h"
#include "tests/stock/test_grid.h"
#include "tests/support/temporary_directory.h"

namespace weir::playback_test {
namespace {

// Counts the volumes that exist at a time.
class CountedVolume : public LoadedVolume {
 public:
  CountedVolume(std::atomic<int>& alive, std::atomic<int>& most, float value) : alive_(alive) {
    const int now = ++alive_;
    most = std::max<int>(most, now);
    info_.background = value;
  }
  ~CountedVolume() override { --alive_; }
  const VolumeInfo& info() const override { return info_; }
  const LoadSummary& load_summary() const override { return summary_; }

 private:
  std::atomic<int>& alive_;
  VolumeInfo info_;
  LoadSummary summary_{"counted", 0, 0, ""};
};

// Its picture is one pixel with the value of the volume's background. It sleeps instead of working.
class FakeBackend : public Backend {
 public:
  std::string_view name() const override { return "fake"; }
  std::unique_ptr<LoadedVolume> load(std::shared_ptr<const NvdbFile> file, std::int64_t /*cell*/,
                                     std::unique_ptr<LoadedVolume> reuse) override {
    if (reuse) ++reused;
    reuse.reset();
    ++loads;
    if (alive >= room) throw Error(ErrorKind::io, "no room");
    std::this_thread::sleep_for(load_time);
    return std::make_unique<CountedVolume>(alive, most, file->grid().background());
  }
  std::unique_ptr<LoadedVolume> load_dense(std::shared_ptr<const DenseVolume>, std::int64_t) override {
    return nullptr;
  }
  Picture render(LoadedVolume& volume, const Scene&, const RenderOptions&, const SampleOptions&) override {
    std::this_thread::sleep_for(render_time);
    const float value = volume.info().background;
    if (value == fails_at) throw Error(failure, "stopped");
    Picture picture;
    picture.image = Image(1, 1);
    picture.image.pixels[0] = {value, 0, 0};
    return picture;
  }

  std::chrono::milliseconds load_time{0};
  std::chrono::milliseconds render_time{0};
  float fails_at = -1;
  ErrorKind failure = ErrorKind::interrupted;
  std::atomic<int> alive{0};
  std::atomic<int> most{0};
  int room = 2;  // number of volumes
  int loads = 0;
  int reused = 0;
};

class Playback : public ::testing::Test {
 protected:
  /// Writes a file of a box with the value 0.5.
  void make_step(const Box& box, const test::TestGridOptions& options) {
    const test::TestGrid grid(
        box, [](const Index3&) { return 0.5F; }, options);
    files_.push_back(directory_ / std::to_string(files_.size()));
    const std::span<const std::byte> bytes = grid.file();
    std::ofstream(files_.back(), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }
  /// Writes one file per background, in order.
  void make(int steps) {
    for (int step = 0; step < steps; ++step) {
      test::TestGridOptions options;
      options.background = static_cast<float>(step);
      make_step({{0, 0, 0}, {1, 1, 1}}, options);
    }
  }
  PlaybackReport run() {
    return play(backend_, files_, {}, {}, {}, [&](std::size_t frame, const Picture& picture) {
      std::this_thread::sleep_for(write_time_);
      if (frame == write_fails_at_) throw Error(ErrorKind::io, "disk full");
      frames_.emplace_back(frame, picture.image.pixels[0].x);
    });
  }
  std::string error() {
    try {
      run();
    } catch (const Error& e) {
      return e.what();
    }
    return "none";
  }

  using Frames = std::vector<std::pair<std::size_t, float>>;
  TemporaryDirectory directory_;
  std::vector<std::string> files_;
  FakeBackend backend_;
  std::chrono::milliseconds write_time_{0};
  std::size_t write_fails_at_ = 1000;
  Frames frames_;
};

TEST_F(Playback, FramesInOrderFromTwoVolumes) {
  make(7);
  const PlaybackReport report = run();
  EXPECT_EQ(frames_, (Frames{{0, 0}, {1, 1}, {2, 2}, {3, 3}, {4, 4}, {5, 5}, {6, 6}}));
  EXPECT_EQ(report.frames, 7U);
  EXPECT_EQ(report.load.way, "counted");
  EXPECT_LE(backend_.most, 2);
  EXPECT_EQ(backend_.reused, 5) << "all but the first two";
  EXPECT_EQ(backend_.alive, 0);
}

// Fog of one value looks the same through 16 world units, whatever the rest of the volume is.
TEST_F(Playback, StepsOfDifferentBoxes_HaveOneExtinction) {
  make_step({{0, 0, 0}, {16, 16, 16}}, {});
  make_step({{0, 0, 0}, {16, 16, 64}}, {});
  test::TestGridOptions fine;
  fine.voxel_size = {0.5, 0.5, 0.5};
  make_step({{0, 0, 0}, {32, 32, 64}}, fine);
  Scene scene;
  scene.mode = RenderMode::dvr;
  scene.camera.position = {-30, 8, 8};
  scene.camera.look_at = {8, 8, 8};
  scene.camera.fov = 1;
  scene.volume.range = {0, 1};
  scene.volume.opacity = {{0, 0}, {1, 1}};
  scene.volume.colormap = "white";
  scene.volume.density = 2;
  scene.volume.shading = 0;
  scene.lighting.background = {0, 0, 0};
  RenderOptions options;
  options.width = options.height = 1;
  const std::unique_ptr<Backend> cpu = make_cpu_backend(1);
  std::vector<float> centres;
  play(*cpu, files_, scene, options, {},
       [&](std::size_t, const Picture& picture) { centres.push_back(picture.image.pixels[0].x); });
  ASSERT_EQ(centres.size(), 3U);
  // A density of 2 times an opacity of a half is 1 along 16 units. The fog is thinner within a voxel of its border.
  EXPECT_GT(centres[0], 1 - std::exp(-14.5F / 16));
  EXPECT_LT(centres[0], 1 - std::exp(-1.0F));
  EXPECT_EQ(centres[1], centres[0]);
  EXPECT_NEAR(centres[2], centres[0], 0.02F) << "samples lie elsewhere";
}

TEST_F(Playback, PlaysNoFileAndOneFile) {
  EXPECT_EQ(run().frames, 0U);
  make(1);
  const PlaybackReport report = run();
  EXPECT_EQ(frames_, (Frames{{0, 0}}));
  EXPECT_GT(report.sustained, 0);
}

// Three stages of equal length run side by side, and together take far less time than one after the other.
TEST_F(Playback, StagesOverlapAndAreTimed) {
  make(6);
  backend_.load_time = write_time_ = std::chrono::milliseconds(40);
  backend_.render_time = std::chrono::milliseconds(60);
  const PlaybackReport report = run();
  EXPECT_EQ(report.limit(), "render");
  EXPECT_GE(report.load_s, 0.24);
  EXPECT_GE(report.render_s, 0.36);
  EXPECT_GE(report.write_s, 0.24);
  EXPECT_LT(report.total_s, 0.75 * (report.load_s + report.render_s + report.write_s));
  EXPECT_GT(report.sustained, 0);
}

TEST_F(Playback, TheLimitIsTheLongestStage) {
  PlaybackReport report;
  report.load_s = 2;
  report.render_s = 1;
  report.write_s = 1.5;
  EXPECT_EQ(report.limit(), "load");
  report.write_s = 3;
  EXPECT_EQ(report.limit(), "write");
}

TEST_F(Playback, MissingFile_FailsAfterTheFramesBefore) {
  make(4);
  write_time_ = std::chrono::milliseconds(20);
  files_[2] = directory_ / "none";
  EXPECT_NE(error().find(files_[2]), std::string::npos);
  EXPECT_EQ(frames_, (Frames{{0, 0}, {1, 1}}));
  EXPECT_EQ(backend_.alive, 0);
}

TEST_F(Playback, NoRoomForTwoVolumes_OneAfterTheOtherIsPlayed) {
  make(4);
  backend_.room = 1;
  run();
  EXPECT_EQ(frames_, (Frames{{0, 0}, {1, 1}, {2, 2}, {3, 3}}));
  EXPECT_EQ(backend_.loads, 7) << "all but the first twice";
}

TEST_F(Playback, NoRoomForAnyVolume_IsTheErrorOfTheFirst) {
  make(2);
  backend_.room = 0;
  EXPECT_EQ(error(), "no room");
  EXPECT_EQ(backend_.loads, 1);
}

TEST_F(Playback, FailedRendering_FailsAfterTheFramesBefore) {
  make(4);
  write_time_ = std::chrono::milliseconds(20);
  backend_.fails_at = 2;
  EXPECT_EQ(error(), "stopped");
  EXPECT_EQ(frames_, (Frames{{0, 0}, {1, 1}}));
  EXPECT_EQ(backend_.alive, 0);
}

TEST_F(Playback, VolumeThatCannotBeRendered_IsNamed) {
  make(4);
  backend_.fails_at = 2;
  backend_.failure = ErrorKind::usage;
  EXPECT_EQ(error(), files_[2] + ": stopped");
}

TEST_F(Playback, FailedWrite_StopsThePlayback) {
  make(5);
  write_fails_at_ = 1;
  EXPECT_EQ(error(), "disk full");
  EXPECT_EQ(frames_, (Frames{{0, 0}}));
}

TEST_F(Playback, FailedWriteOfTheLastFrame_IsReported) {
  make(2);
  write_fails_at_ = 1;
  EXPECT_EQ(error(), "disk full");
}

}  // namespace
}  // namespace weir::playback_test
