// Renders the pictures of all viewers, one after the other, in a separate thread. Moving views come before still views,
// new still views before those that are being refined, and the viewer that waited longest comes first. A viewer has at
// most one picture under way. Nothing is drawn for it until that picture is taken, so a slow viewer does not delay
// others.
//
// A pass of a still picture makes room at once for a moving view, and after RenderLoop::kSlice for any other viewer
// that waits. The part that was drawn is kept, and the viewer's next turn continues it. If nothing could be kept, that
// turn lasts twice as long. A viewer that was passed over kMostPassedOver times comes first and has a whole slice, so
// that many moving views do not keep it from refining.
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

/// The files of each step, and what all pictures have in common.
struct RenderedSeries {
  const StepList& steps;             ///< outlives the loop
  std::vector<std::string> against;  ///< files to compare with: none, one for all steps, or one for each
  std::optional<float> background;   ///< background of all steps of a series
};

/// Called on the loop's thread; must not block.
struct RenderEvents {
  /// A picture. The viewer gets no other picture until taken().
  std::function<void(ViewerId, const FrameHeader&, std::vector<std::byte> picture)> frame;
  /// Progress of a long pass, as a share in [0, 1], or of loading a volume.
  std::function<void(ViewerId, std::int64_t view, std::string_view what, double share)> progress;
  std::function<void(ViewerId, std::int64_t view, std::string message)> failed;
};

class RenderLoop {
 public:
  static constexpr std::chrono::milliseconds kSlice{250};
  static constexpr int kMostPassedOver = 40;  ///< turns: some two seconds while other views move

  /// `shelf` and `backend` must outlive the object.
  RenderLoop(Backend& backend, VolumeShelf& shelf, RenderedSeries series, RenderEvents events);
  /// Ends the threads; no event comes afterwards.
  ~RenderLoop();
  RenderLoop(const RenderLoop&) = delete;
  RenderLoop& operator=(const RenderLoop&) = delete;

  // Any thread may call the following functions.
  /// Sets the newest view of a viewer, which replaces all its previous views.
  void show(ViewerId viewer, ViewRequest view);
  /// Tells that the viewer has shown its picture, number `frame`.
  void taken(ViewerId viewer, std::int64_t frame);
  void remove(ViewerId viewer);

 private:
  using Clock = std::chrono::steady_clock;
  using Progress = UnfinishedPass::Progress;
  using Request = std::shared_ptr<const ViewRequest>;

  struct Viewer {
    Request request;
    bool fresh = false;           // nothing of the request is drawn yet
    Request drawn;                // request of the last picture
    std::int64_t frame = 0;       // number of the last picture
    bool under_way = false;       // the last picture is not taken yet
    Clock::time_point started{};  // when its drawing began
    std::uint64_t samples = 0;    // pixel samples in it; 0 if it does not count for the pace
    Clock::time_point served{};
    Clock::time_point moved{};
    FramePace pace;
    std::shared_ptr<Refinement> refinement;  // of the request, if the view is still
    int passed_over = 0;  // turns of others since this viewer last finished a pass or had a whole slice
    int in_vain = 0;      // consecutive slices of which nothing could be kept
  };

  struct Turn {
    ViewerId viewer = 0;
    Request request;
    bool moving = false;
    FrameSize size;
    std::shared_ptr<Refinement> refinement;  // null if the view moves
    int in_vain = 0;                         // Viewer::in_vain
    // Returns whether the view moves and cannot be drawn smaller.
    bool least() const { return moving && size == scaled(request->width, request->height, FramePace::kLeast); }
  };

  // A moving picture that was stopped because it took too long.
  struct Late {
    std::uint64_t samples = 0;  // pixel samples that were done
    double seconds = 0;         // seconds that these samples took
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
  std::optional<Turn> turn_;                    // the turn that is being drawn
  std::optional<Clock::time_point> slice_end_;  // of turn_; none while its volume loads or if it moves
  bool slice_over_ = false;                     // turn_ made room because its slice ended
  bool loaded_ = false;                         // a volume was loaded during this picture; used only by thread_
  std::optional<Late> late_;                    // of the turn; set at most once by a renderer thread
  std::string warned_;                          // last Picture::memory_note that was logged; used only by thread_
  std::atomic<bool> cancel_{false};
  bool ended_ = false;
  std::thread thread_;
  std::thread slices_;  // runs end_slices()
};

}  // namespace weir
