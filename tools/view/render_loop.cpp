#include "tools/view/render_loop.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "format/base/error.h"
#include "format/base/seconds_since.h"
#include "format/base/text.h"
#include "gpu/image/image_output.h"
#include "tools/view/compared_scene.h"
#include "tools/view/jpeg_picture.h"

namespace weir {
namespace {

constexpr int kMovingQuality = 88;  // JPEG quality
constexpr int kSmallQuality = 90;   // JPEG quality of a still picture that is not whole yet
constexpr int kMostDoublings = 16;  // doublings of a slice: hours
constexpr std::chrono::milliseconds kStillMoving{500};
constexpr std::chrono::milliseconds kProgress{200};
// A moving picture that takes longer is stopped and drawn again, smaller. At the least size it fails instead.
constexpr double kLongestMoving_s = 2 * FramePace::kLongest_s;
constexpr double kLongestSmall_s = 10;

}  // namespace

RenderLoop::RenderLoop(Backend& backend, VolumeShelf& shelf, RenderedSeries series, RenderEvents events)
    : backend_(backend), shelf_(shelf), series_(std::move(series)), events_(std::move(events)) {
  try {
    thread_ = std::thread([this] { run(); });
    slices_ = std::thread([this] { end_slices(); });
  } catch (...) {
    end();
    throw;
  }
}

RenderLoop::~RenderLoop() { end(); }

void RenderLoop::end() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    cancel_ = true;
  }
  changed_.notify_all();
  for (std::thread* const thread : {&thread_, &slices_}) {
    if (thread->joinable()) thread->join();
  }
}

void RenderLoop::show(ViewerId id, ViewRequest view) {
  {
    const std::lock_guard lock(mutex_);
    Viewer& viewer = viewers_[id];
    const auto now = Clock::now();
    if (view.moving) viewer.moved = now;
    viewer.request = std::make_shared<const ViewRequest>(std::move(view));
    viewer.fresh = true;
    viewer.refinement.reset();
    viewer.in_vain = 0;
    if (turn_ && turn_->viewer == id && !turn_->moving) cancel_ = true;
    make_room(viewer);
  }
  changed_.notify_all();
}

void RenderLoop::taken(ViewerId id, std::int64_t frame) {
  {
    const std::lock_guard lock(mutex_);
    const auto found = viewers_.find(id);
    if (found == viewers_.end() || !found->second.under_way || found->second.frame != frame) return;
    Viewer& viewer = found->second;
    viewer.under_way = false;
    if (viewer.samples > 0) viewer.pace.add(viewer.samples, seconds_since(viewer.started));
    make_room(viewer);
  }
  changed_.notify_all();
}

// Ends the current still pass at once if `viewer` moves. For a still view end_slices() does so later. mutex_ is held.
void RenderLoop::make_room(const Viewer& viewer) {
  if (!viewer.fresh || viewer.under_way || !viewer.request->moving || !turn_ || turn_->moving) return;
  const auto drawn = viewers_.find(turn_->viewer);
  if (drawn != viewers_.end() && drawn->second.passed_over < kMostPassedOver) cancel_ = true;
}

void RenderLoop::remove(ViewerId id) {
  const std::lock_guard lock(mutex_);
  viewers_.erase(id);
  if (turn_ && turn_->viewer == id) cancel_ = true;
}

int RenderLoop::moving_viewers() const {
  const auto now = Clock::now();
  return static_cast<int>(std::count_if(viewers_.begin(), viewers_.end(), [&](const auto& entry) {
    return entry.second.moved != Clock::time_point{} && now - entry.second.moved < kStillMoving;
  }));
}

// Returns whether there is something to draw for `viewer`. mutex_ is held.
bool RenderLoop::waits(const Viewer& viewer) {
  if (viewer.under_way || !viewer.request) return false;
  return viewer.fresh || (!viewer.request->moving && viewer.refinement && viewer.refinement->next());
}

// Returns whether a viewer other than that of turn_ waits. mutex_ is held.
bool RenderLoop::another_waits() const {
  return std::any_of(viewers_.begin(), viewers_.end(),
                     [&](const auto& entry) { return entry.first != turn_->viewer && waits(entry.second); });
}

// Times the still passes in a separate thread, because a back end reports progress too seldom.
void RenderLoop::end_slices() {
  std::unique_lock lock(mutex_);
  while (!ended_) {
    if (!slice_end_ || slice_over_ || !another_waits()) {
      changed_.wait(lock);
    } else if (const auto until = *slice_end_; Clock::now() < until) {
      changed_.wait_until(lock, until);
    } else {
      slice_over_ = true;
      cancel_ = true;
    }
  }
}

// Begins a slice that is at least as long as the turn has taken to load its volume. Otherwise two files that do not
// fit into memory together would be loaded again and again for almost no drawing.
void RenderLoop::begin_slice(const Turn& turn, Clock::time_point turn_began) {
  {
    const std::lock_guard lock(mutex_);
    if (slice_end_) return;
    const auto now = Clock::now();
    const Clock::duration slice = kSlice * (1 << std::min(turn.in_vain, kMostDoublings));
    slice_end_ = now + std::max(slice, now - turn_began);
  }
  changed_.notify_all();
}

// Returns whose turn it is and what to draw; nullopt if nobody waits. mutex_ is held.
std::optional<RenderLoop::Turn> RenderLoop::next_turn() {
  Viewer* chosen = nullptr;
  ViewerId id = 0;
  const auto rank = [](const Viewer& v) {
    const bool first = v.passed_over >= kMostPassedOver || (v.fresh && v.request->moving);
    return std::tuple(first ? 0 : (v.fresh ? 1 : 2), v.served);
  };
  for (auto& [key, viewer] : viewers_) {
    if (!waits(viewer)) continue;
    if (chosen != nullptr && rank(*chosen) <= rank(viewer)) continue;
    chosen = &viewer;
    id = key;
  }
  if (chosen == nullptr) return std::nullopt;
  for (auto& [key, viewer] : viewers_) {
    if (key != id && waits(viewer)) ++viewer.passed_over;
  }
  const ViewRequest& view = *chosen->request;
  const int layers = view.against ? 2 : 1;
  Turn turn{id, chosen->request, view.moving, {}, nullptr, chosen->in_vain};
  const FrameSize moving = chosen->pace.next(view.width, view.height, layers, std::max(moving_viewers(), 1));
  if (view.moving) {
    turn.size = moving;
  } else {
    if (!chosen->refinement) {
      // A view that was just shown small need not start as small again.
      const bool seen = chosen->drawn && chosen->drawn->scene_text == view.scene_text &&
                        chosen->drawn->step == view.step && chosen->drawn->against == view.against;
      const double share = static_cast<double>(moving.width) / view.width * (seen ? 2 : 1);
      chosen->refinement =
          std::make_shared<Refinement>(view.width, view.height, layers, share, converged_samples(view.scene.mode));
    }
    turn.refinement = chosen->refinement;
  }
  chosen->fresh = false;
  return turn;
}

void RenderLoop::run() {
  for (;;) {
    std::optional<Turn> turn;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return ended_ || (turn = next_turn()); });
      if (ended_) return;
      turn_ = turn;
      cancel_ = false;
      slice_over_ = false;
    }
    const auto progress = [&] { return turn->refinement ? turn->refinement->unfinished().progress() : Progress(); };
    const Progress before = progress();
    bool done = false;
    late_.reset();
    try {
      draw(*turn);
      done = true;
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::interrupted) {
        if (late_) draw_smaller(*turn, *late_);
      } else {
        done = true;
        if (turn->refinement) *turn->refinement = Refinement();  // another pass would fail in the same way
        events_.failed(turn->viewer, turn->request->id, error.what());
      }
    } catch (const std::exception& error) {
      done = true;
      if (turn->refinement) *turn->refinement = Refinement();
      events_.failed(turn->viewer, turn->request->id, error.what());
    }
    end_turn(*turn, done, progress() > before);
  }
}

void RenderLoop::end_turn(const Turn& turn, bool done, bool progressed) {
  const std::lock_guard lock(mutex_);
  turn_.reset();
  slice_end_.reset();
  const auto found = viewers_.find(turn.viewer);
  if (found == viewers_.end()) return;
  Viewer& viewer = found->second;
  viewer.served = Clock::now();
  if (!done && !slice_over_) return;  // made room for a moving view, or for a newer view of its own
  viewer.passed_over = 0;
  viewer.in_vain = done || progressed ? 0 : viewer.in_vain + 1;
}

void RenderLoop::draw_smaller(const Turn& turn, const Late& late) {
  if (turn.least()) {
    return events_.failed(turn.viewer, turn.request->id,
                          cat("a picture of ", turn.size.width, " x ", turn.size.height, " pixels takes more than ",
                              kLongestSmall_s, " s; choose a lower density, or another mode"));
  }
  const std::lock_guard lock(mutex_);
  const auto found = viewers_.find(turn.viewer);
  if (found == viewers_.end()) return;
  found->second.pace.add(std::max<std::uint64_t>(late.samples, 1), late.seconds);
  if (found->second.request == turn.request) found->second.fresh = true;
}

std::string RenderLoop::file_of(const ViewRequest& view, int layer) const {
  if (layer == 0) return series_.steps.path(view.step);
  return series_.against.at(series_.against.size() == 1 ? 0 : view.step);
}

std::vector<Image> RenderLoop::render(const Turn& turn, const FrameSize& size, std::uint64_t seed, ToneMapping& tone) {
  const ViewRequest& view = *turn.request;
  RenderOptions options;
  options.width = size.width;
  options.height = size.height;
  options.seed = seed;
  options.background = series_.background;
  SampleOptions sampling;
  sampling.samples = size.samples;
  sampling.draft = turn.moving;
  sampling.cancel = &cancel_;
  const int layers = view.against ? 2 : 1;
  const double all = static_cast<double>(size.width) * size.height * size.samples * layers;
  UnfinishedPass moving;
  UnfinishedPass& pass = turn.refinement ? turn.refinement->unfinished() : moving;
  if (turn.refinement) sampling.kept = &pass.next_layer;
  const Clock::time_point started = Clock::now();
  Clock::time_point told = started;
  for (int layer = static_cast<int>(pass.layers.size()); layer < layers; ++layer) {
    const std::string file = file_of(view, layer);
    if (!shelf_.has(file)) {
      loaded_ = true;
      events_.progress(turn.viewer, view.id, "load", 0);
    }
    const std::shared_ptr<LoadedVolume> volume = shelf_.get(file);
    const GridFrame& frame = volume->info().frame;
    if (layer == 0) pass.frame = frame;
    const std::optional<Scene> scene = layer == 0 ? view.scene : scene_of_other(view.scene, pass.frame, frame);
    if (turn.moving) {
      const auto begun = Clock::now();
      const double longest_s = turn.least() ? kLongestSmall_s : kLongestMoving_s;
      sampling.progress = [&, begun, longest_s, layer](std::uint64_t done) {
        const double spent_s = seconds_since(begun);
        if (spent_s < longest_s || cancel_) return;
        late_ = Late{static_cast<std::uint64_t>(all / layers * layer) + done, spent_s};
        cancel_ = true;
      };
    } else {
      begin_slice(turn, started);
      sampling.progress = [&, layer](std::uint64_t done) {
        if (Clock::now() - told < kProgress) return;
        told = Clock::now();
        events_.progress(turn.viewer, view.id, "render", (all / layers * layer + static_cast<double>(done)) / all);
      };
    }
    Picture picture = backend_.render(*volume, scene ? *scene : without_volume(view.scene), options, sampling);
    if (!picture.memory_note.empty() && picture.memory_note != warned_) {
      warned_ = picture.memory_note;
      spdlog::warn("{}: {}", file, warned_);
    }
    tone = picture.tone;
    pass.layers.push_back(std::move(picture.image));
  }
  if (const auto next = series_.steps.after(view.step)) shelf_.prefetch(series_.steps.path(*next));
  return std::exchange(pass.layers, {});
}

void RenderLoop::draw(const Turn& turn) {
  const ViewRequest& view = *turn.request;
  const auto started = Clock::now();
  loaded_ = false;
  ToneMapping tone;
  FrameHeader header;
  header.view = view.id;
  header.layers = view.against ? 2 : 1;
  header.step = view.step;
  header.moving = turn.moving;
  header.of = converged_samples(view.scene.mode);
  const auto samples_of = [&](const FrameSize& size) {
    return static_cast<std::uint64_t>(size.width) * static_cast<std::uint64_t>(size.height) * size.samples *
           static_cast<std::uint64_t>(header.layers);
  };
  if (turn.moving) {
    const Image picture = stacked(render(turn, turn.size, 0, tone));
    header.render_s = seconds_since(started);
    header.samples = turn.size.samples;
    return deliver(turn, header, picture, tone, started, loaded_ ? 0 : samples_of(turn.size));
  }
  const std::optional<RefinementPass> pass = turn.refinement->next();
  if (!pass) return;
  turn.refinement->add(*pass, render(turn, pass->size, pass->seed, tone));
  header.render_s = seconds_since(started);
  if (!pass->shown) return;
  header.samples = turn.refinement->samples();
  // 0 samples: a PNG of all passes since the last picture says nothing about the pace of moving pictures.
  deliver(turn, header, turn.refinement->picture(), tone, started, 0);
}

void RenderLoop::deliver(const Turn& turn, FrameHeader header, const Image& picture, const ToneMapping& tone,
                         Clock::time_point started, std::uint64_t samples) {
  header.width = picture.width;
  header.height = picture.height / header.layers;
  const bool whole = !turn.moving && header.samples > 0;
  header.format = whole || !has_jpeg() ? "png" : "jpeg";
  std::vector<std::byte> bytes = header.format == "png"
                                     ? encode_png(picture, tone)
                                     : encode_jpeg(picture, tone, turn.moving ? kMovingQuality : kSmallQuality);
  {
    const std::lock_guard lock(mutex_);
    const auto found = viewers_.find(turn.viewer);
    if (found == viewers_.end()) return;
    Viewer& viewer = found->second;
    header.frame = ++viewer.frame;
    viewer.under_way = true;
    viewer.drawn = turn.request;
    viewer.started = started;
    viewer.samples = samples;
  }
  events_.frame(turn.viewer, header, std::move(bytes));
}

}  // namespace weir
