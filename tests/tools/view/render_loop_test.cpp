// Tests how the pages' pictures share one thread: who makes room for whom, and that nobody waits for ever.
#include "tools/view/render_loop.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "format/base/error.h"
#include "tests/support/packed_sample.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_directory.h"

namespace weir::render_loop_test {
namespace {

using std::chrono::milliseconds;

class NoVolume : public LoadedVolume {
 public:
  const VolumeInfo& info() const override { return info_; }
  const LoadSummary& load_summary() const override { return summary_; }

 private:
  VolumeInfo info_;
  LoadSummary summary_;
};

// A picture of mode path takes as long as slow(), which throws if it is cancelled; all other pictures are immediate.
class SlowPathBackend : public Backend {
 public:
  std::string_view name() const override { return "slow"; }
  std::unique_ptr<LoadedVolume> load(std::shared_ptr<const NvdbFile>, std::int64_t,
                                     std::unique_ptr<LoadedVolume>) override {
    return std::make_unique<NoVolume>();
  }
  std::unique_ptr<LoadedVolume> load_dense(std::shared_ptr<const DenseVolume>, std::int64_t) override {
    return nullptr;
  }
  Picture render(LoadedVolume&, const Scene& scene, const RenderOptions& options,
                 const SampleOptions& sampling) override {
    if (scene.mode == RenderMode::path) {
      ++slow_calls;
      slow(sampling);
    }
    Picture picture;
    picture.image = Image(options.width, options.height);
    return picture;
  }

  static void wait_until_cancelled(const SampleOptions& sampling) {
    while (!*sampling.cancel) std::this_thread::sleep_for(milliseconds(1));
    throw Error(ErrorKind::interrupted, "interrupted");
  }

  std::function<void(const SampleOptions&)> slow = wait_until_cancelled;
  std::atomic<int> slow_calls{0};
};

ViewRequest view(RenderMode mode, bool moving) {
  ViewRequest request;
  request.id = 1;
  request.scene.mode = mode;
  request.scene_text = render_mode_name(mode);
  request.width = 8;
  request.height = 6;
  request.moving = moving;
  return request;
}

class RenderLoopTest : public testing::Test {
 protected:
  RenderLoopTest() {
    const test::PackedFile made = test::PackedSample::build();
    write_file(file_, std::string(reinterpret_cast<const char*>(made.file.data()), made.file.size()));
    loop_.emplace(backend_, shelf_, RenderedSeries{steps_, {}, {}},
                  RenderEvents{[this](ViewerId id, const FrameHeader& header, const std::vector<std::byte>&) {
                                 if (on_frame) on_frame(id, header);
                                 const std::lock_guard lock(mutex_);
                                 ++frames_[id];
                                 changed_.notify_all();
                               },
                               [](ViewerId, std::int64_t, std::string_view, double) {},
                               [](ViewerId, std::int64_t, const std::string& message) { ADD_FAILURE() << message; }});
  }

  /// Returns whether a picture of the viewer comes before the test's time is up.
  bool gets_a_picture(ViewerId id) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, std::chrono::seconds(30), [&] { return frames_[id] > 0; });
  }
  void wait_for_slow_call() const {
    while (backend_.slow_calls == 0) std::this_thread::sleep_for(milliseconds(1));
  }
  /// Takes every picture of the viewer at once and asks for another.
  void always_ask(ViewerId id, bool moving) {
    asking_.emplace(id, moving);
    on_frame = [this, &loop = *loop_](ViewerId of, const FrameHeader& header) {
      const auto asks = asking_.find(of);
      if (asks == asking_.end()) return;
      loop.taken(of, header.frame);
      loop.show(of, view(RenderMode::mip, asks->second));
    };
  }

  const TemporaryDirectory directory_;
  const std::string file_ = directory_ / "v.nvdb";
  SlowPathBackend backend_;
  VolumeShelf shelf_{backend_, 1};
  StepList steps_{{file_}};
  std::function<void(ViewerId, const FrameHeader&)> on_frame;
  std::map<ViewerId, bool> asking_;  // by viewer: whether the view moves
  std::vector<std::uint64_t> kept_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<ViewerId, int> frames_;
  std::optional<RenderLoop> loop_;  // ends first
};

TEST_F(RenderLoopTest, SlowStillPass_MakesRoomForTheStillViewOfAnother) {
  loop_->show(1, view(RenderMode::path, false));
  wait_for_slow_call();
  loop_->show(2, view(RenderMode::mip, false));
  EXPECT_TRUE(gets_a_picture(2));
}

TEST_F(RenderLoopTest, SlowStillPass_MakesRoomForEveryMovingView) {
  loop_->show(1, view(RenderMode::path, false));
  wait_for_slow_call();
  for (ViewerId id = 2; id < 10; ++id) {
    loop_->show(id, view(RenderMode::mip, true));
    ASSERT_TRUE(gets_a_picture(id)) << id;
  }
}

TEST_F(RenderLoopTest, PassThatMadeRoom_GoesOnWithWhatWasKept) {
  backend_.slow = [this](const SampleOptions& sampling) {
    kept_.push_back(sampling.kept->drawn());
    if (kept_.size() == 4) {
      *sampling.kept = {};
      return;
    }
    sampling.kept->samples.push_back(1);
    SlowPathBackend::wait_until_cancelled(sampling);
  };
  always_ask(2, false);
  loop_->show(1, view(RenderMode::path, false));
  wait_for_slow_call();
  loop_->show(2, view(RenderMode::mip, false));
  ASSERT_TRUE(gets_a_picture(1));
  loop_.reset();
  EXPECT_EQ(kept_, (std::vector<std::uint64_t>{0, 1, 2, 3}));
}

// The back end keeps nothing of an interrupted pass, like a device. So the turns grow until a pass ends within one
// turn.
TEST_F(RenderLoopTest, PassOfWhichNothingIsKept_EndsAllTheSame) {
  backend_.slow = [](const SampleOptions& sampling) {
    const auto end = std::chrono::steady_clock::now() + 3 * RenderLoop::kSlice / 2;
    while (std::chrono::steady_clock::now() < end) {
      if (*sampling.cancel) throw Error(ErrorKind::interrupted, "interrupted");
      std::this_thread::sleep_for(milliseconds(1));
    }
  };
  always_ask(2, false);
  loop_->show(1, view(RenderMode::path, false));
  wait_for_slow_call();
  loop_->show(2, view(RenderMode::mip, false));
  EXPECT_TRUE(gets_a_picture(1));
}

TEST_F(RenderLoopTest, ViewersThatAlwaysMove_LetAStillOneRefine) {
  // The moving viewer also asks in the middle of the pass.
  backend_.slow = [&loop = *loop_](const SampleOptions& sampling) {
    loop.show(1, view(RenderMode::mip, true));
    if (*sampling.cancel) throw Error(ErrorKind::interrupted, "interrupted");
  };
  always_ask(1, true);
  always_ask(2, true);
  loop_->show(1, view(RenderMode::mip, true));
  loop_->show(2, view(RenderMode::mip, true));
  ASSERT_TRUE(gets_a_picture(1));
  loop_->show(3, view(RenderMode::path, false));
  EXPECT_TRUE(gets_a_picture(3));
}

}  // namespace
}  // namespace weir::render_loop_test
