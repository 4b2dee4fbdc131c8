// Makes the pictures of all viewers, one after the other, in a thread of its own: moving views before still ones, new
// still ones before those that are refined, the viewer that waited longest first. A viewer has one picture under way at
// most; until it was taken nothing is drawn for it, so that a slow one costs the others nothing.
//
// A pass of a still picture makes room for a moving view at once, and for any other viewer that waits when it has run
// for RenderLoop::kSlice. What was drawn of it is kept, and the viewer's next turn goes on with it. Where nothing could
// be kept, that turn lasts twice as long. A viewer that was passed over kMostPassedOver times comes first, and has its
// slice whole: many moving views do not keep it from refining.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "gpu/render/backend.h"
#include "tools/view/base/view_message.h"
#include "tools/view/frame_pace.h"
#include "tools/view/refinement.h"
#include "tools/view/steps/step_list.h"
#include "tools/view/volume_shelf.h"

namespace weir {

/// What is rendered: the files of each step, and what all pictures have in common.
struct RenderedSeries {
  const StepList& steps;             ///< outlives the loop
  std::vector<std::string> against;  ///< none, one for all steps, or one for each
  std::optional<float> background;   ///< of all steps of a series
};

/// Called on the loop's thread; must not block.
struct RenderEvents {
  /// A picture, which the viewer has until taken().
  std::function<void(ViewerId, const FrameHeader&, std::vector<std::byte> picture)> frame;
  /// A pass that takes long: share of it, in [0, 1], or a volume that is being loaded.
  std::function<void(ViewerId, std::int64_t view, std::string_view what, double share)> progress;
  std::function<void(ViewerId, std::int64_t view, std::string message)> failed;
};

class RenderLoop {
 public:
  static constexpr std::chrono::milliseconds kSlice{250};
  static constexpr int kMostPassedOver = 40;  ///< turns: some two seconds of moving views

  /// `shelf` and `backend` must outlive the object.
  RenderLoop(Backend& backend, VolumeShelf& shelf, RenderedSeries series, RenderEvents events);
  /// No event comes afterwards.
  ~RenderLoop();
  RenderLoop(const RenderLoop&) = delete;
  RenderLoop& operator=(const RenderLoop&) = delete;

  // From any thread.
  /// The newest view of a viewer takes the place of all before it.
  void show(ViewerId viewer, ViewRequest view);
  /// The viewer has shown its picture, number `frame`.
  void taken(ViewerId viewer, std::int64_t frame);
  void remove(ViewerId viewer);

 private:
  using Clock = std::chrono::steady_clock;
  using Progress = UnfinishedPass::Progress;
  using Request = std::shared_ptr<const ViewRequest>;

  struct Viewer {
    Request request;
    bool fresh = false;           // nothing of the request was drawn yet
    Request drawn;                // of the last picture
    std::int64_t frame = 0;       // number of the last picture
    bool under_way = false;       // it was not taken yet
    Clock::time_point started{};  // of its drawing
    std::uint64_t samples = 0;    // in it, where it counts for the pace
    Clock::time_point served{};
    Clock::time_point moved{};
    FramePace pace;
    std::shared_ptr<Refinement> refinement;  // of the request, where it is still
    int passed_over = 0;  // turns of others while it waited, since it finished a pass or had a whole slice
    int in_vain = 0;      // slices in a row of which nothing could be kept
  };

  struct Turn {
    ViewerId viewer = 0;
    Request request;
    bool moving = false;
    FrameSize size;
    std::shared_ptr<Refinement> refinement;  // null where it moves
    int in_vain = 0;                         // Viewer::in_vain
    // Whether it moves and cannot be drawn smaller.
    bool least() const { return moving && size == scaled(request->width, request->height, FramePace::kLeast); }
  };

  // A moving picture that was given up.
  struct Late {
    std::uint64_t samples = 0;  // that were done
    double seconds = 0;         // that they took
  };

  void end();
  void make_room(const Viewer& viewer);
  static bool waits(const Viewer& viewer);
  bool another_waits() const;
  void run();
  void end_slices();
  void begin_slice(const Turn& turn, Clock::time_point turn_began);
  std::optional<Turn> next_turn();
  void draw(const Turn& turn);
  std::vector<Image> render(const Turn& turn, const FrameSize& size, std::uint64_t seed, ToneMapping& tone);
  void deliver(const Turn& turn, FrameHeader header, const Image& picture, const ToneMapping& tone,
               Clock::time_point started, std::uint64_t samples);
  void draw_smaller(const Turn& turn, const Late& late);
  void end_turn(const Turn& turn, bool done, bool progressed);
  std::string file_of(const ViewRequest& view, int layer) const;
  int moving_viewers() const;

  Backend& backend_;
  VolumeShelf& shelf_;
  const RenderedSeries series_;
  const RenderEvents events_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<ViewerId, Viewer> viewers_;
  std::optional<Turn> turn_;                    // that is being drawn
  std::optional<Clock::time_point> slice_end_;  // of turn_; none while its volume is loaded, and where it moves
  bool slice_over_ = false;                     // it made room because of that
  bool loaded_ = false;                         // while the picture was drawn; of thread_ alone
  std::optional<Late> late_;                    // of the turn; set by one of the renderer's threads, at most once
  std::string warned_;                          // of, last: Picture::memory_note; of thread_ alone
  std::atomic<bool> cancel_{false};
  bool ended_ = false;
  std::thread thread_;
  std::thread slices_;  // ends them
};

}  // namespace weir
