#include "compressor/push/slice_intake.h"

#include <utility>

#include "format/base/index.h"
#include "format/process/fault.h"

namespace weir {
namespace {

std::size_t buffer_bytes(const BlockPlan& plan, std::size_t value_bytes) {
  const Index3 voxels = min(plan.leaves * kLeafDim, plan.lattice.domain.extent());
  return static_cast<std::size_t>(volume(voxels)) * value_bytes;
}

PlaneMask lowest_planes(std::int64_t count) { return static_cast<PlaneMask>((1U << static_cast<unsigned>(count)) - 1); }

}  // namespace

SliceIntake::SliceIntake(const BlockPlan& plan, std::size_t value_bytes, const IntakeRoom& room, SliceSink sink)
    : plan_(plan),
      value_bytes_(value_bytes),
      sink_(std::move(sink)),
      memory_(room.buffers * buffer_bytes(plan_, value_bytes_)),
      parked_(static_cast<std::size_t>(plan_.size())),
      running_(room.workers) {
  if (room.buffers == 0 || room.workers == 0) {
    throw Error(ErrorKind::internal, "a slice intake without buffers or workers");
  }
  for (std::size_t i = room.buffers; i-- > 0;) {
    free_.push_back(memory_.bytes().data() + i * buffer_bytes(plan_, value_bytes_));
  }
  try {
    for (std::size_t i = 0; i < room.workers; ++i) workers_.emplace_back([this] { work(); });
  } catch (...) {  // no more threads can be started: the running ones must end before this object does
    stop();
    throw;
  }
}

SliceIntake::~SliceIntake() { stop(); }

void SliceIntake::stop() {
  {
    const Lock lock(mutex_);
    stopping_ = true;
  }
  for_workers_.notify_all();
}

PlaneMask SliceIntake::all_planes(std::int64_t index) const {
  return lowest_planes(plan_.voxel_box(plan_.leaf_box(index)).extent().z);
}

std::span<std::byte> SliceIntake::values_of(std::int64_t index, std::byte* values) const {
  return {values, static_cast<std::size_t>(plan_.voxel_box(plan_.leaf_box(index)).voxels()) * value_bytes_};
}

void SliceIntake::add(const StridedVoxels& slab) {
  try {
    copy(slab);
  } catch (...) {  // some of the slab is missing now
    throw fail(error_in_flight());
  }
}

void SliceIntake::copy(const StridedVoxels& slab) {
  const Index3 in_layer{plan_.count.x, plan_.count.y, 1};
  const auto layer_of = [&](std::int64_t z) { return floor_div(z, kLeafDim) - plan_.lattice.first.z; };
  for (std::int64_t layer = layer_of(slab.box.lo.z); layer <= layer_of(slab.box.hi.z - 1); ++layer) {
    for (std::int64_t i = 0; i < volume(in_layer); ++i) {
      const std::int64_t index = layer * volume(in_layer) + i;
      const Box voxels = plan_.voxel_box(plan_.leaf_box(index));
      const Box part = intersect(voxels, slab.box);
      Slice& slice = [&]() -> Slice& {
        Lock lock(mutex_);
        return open(lock, index);
      }();
      // Planes of a slice follow each other.
      const std::int64_t below = part.lo.z - voxels.lo.z;
      const auto plane_bytes = static_cast<std::size_t>(part.extent().x * part.extent().y) * value_bytes_;
      copy_voxels(slab, part, slice.values + static_cast<std::size_t>(below) * plane_bytes);
      const auto planes = lowest_planes(part.extent().z) << static_cast<unsigned>(below);
      const Lock lock(mutex_);
      close(index, slice, static_cast<PlaneMask>(planes));
    }
  }
}

// Returns the slice with a buffer, into which the caller copies until it calls close(). A thread that waits here copies
// nothing, so that slices can always be parked in the end.
SliceIntake::Slice& SliceIntake::open(Lock& lock, std::int64_t index) {
  for (;;) {
    if (failure_) throw_ended(lock);
    auto found = open_.find(index);
    if (found == open_.end() && !free_.empty()) {
      found = open_.emplace(index, Slice{free_.back()}).first;
      free_.pop_back();
    }
    if (found != open_.end() && !found->second.parking) {
      ++found->second.adding;
      found->second.last_use = ++uses_;
      return found->second;
    }
    ++waiting_;
    for_workers_.notify_one();
    for_adders_.wait(lock);
    --waiting_;
  }
}

void SliceIntake::close(std::int64_t index, Slice& slice, PlaneMask planes) {
  slice.planes |= planes;
  --slice.adding;
  const PlaneMask parked = parked_[static_cast<std::size_t>(index)];
  if ((slice.planes | parked) == all_planes(index)) {
    complete_.push_back({index, slice.values});
    open_.erase(index);
  } else if (waiting_ == 0) {
    return;
  }
  for_workers_.notify_one();
}

void SliceIntake::work() {
  Lock lock(mutex_);
  try {
    work_until_the_end(lock);
  } catch (...) {
    if (!lock.owns_lock()) lock.lock();
    if (!failure_) failure_ = error_in_flight();
  }
  for_workers_.notify_all();
  if (failure_ && running_ == 1) sink_.abandon();
  --running_;
  for_adders_.notify_all();
}

void SliceIntake::work_until_the_end(Lock& lock) {
  while (!failure_ && !stopping_) {
    if (!complete_.empty()) {
      complete_next(lock);
    } else if (finishing_) {
      return;
    } else if (const auto index = slice_to_park()) {
      park(lock, *index);
    } else {
      for_workers_.wait(lock);
    }
  }
}

void SliceIntake::complete_next(Lock& lock) {
  const Work next = complete_.front();
  complete_.pop_front();
  const PlaneMask parked = parked_[static_cast<std::size_t>(next.slice)];
  lock.unlock();
  sink_.complete(next.slice, parked, values_of(next.slice, next.values));
  lock.lock();
  give_back(next.values);
}

std::optional<std::int64_t> SliceIntake::slice_to_park() const {
  if (waiting_ == 0 || !free_.empty()) return std::nullopt;
  std::optional<std::int64_t> oldest;
  std::uint64_t use = uses_ + 1;
  for (const auto& [index, slice] : open_) {
    if (slice.adding > 0 || slice.parking || slice.last_use > use) continue;
    oldest = index;
    use = slice.last_use;
  }
  return oldest;
}

void SliceIntake::park(Lock& lock, std::int64_t index) {
  Slice& slice = open_.at(index);
  slice.parking = true;
  lock.unlock();
  sink_.park(index, slice.planes, values_of(index, slice.values));
  lock.lock();
  parked_[static_cast<std::size_t>(index)] |= slice.planes;
  std::byte* const values = slice.values;
  open_.erase(index);
  give_back(values);
}

void SliceIntake::give_back(std::byte* values) {
  free_.push_back(values);
  for_adders_.notify_all();
}

void SliceIntake::finish() {
  {
    Lock lock(mutex_);
    finishing_ = true;
    for_workers_.notify_all();
    for_adders_.wait(lock, [this] { return running_ == 0; });
    if (failure_) throw Error(*failure_);
  }
  workers_.clear();
  memory_ = PageBuffer(0);
  parked_ = {};
}

void SliceIntake::check() {
  Lock lock(mutex_);
  if (failure_) throw_ended(lock);
}

Error SliceIntake::fail(const Error& error) {
  Lock lock(mutex_);
  if (!failure_) failure_ = error;
  for_workers_.notify_all();
  for_adders_.wait(lock, [this] { return running_ == 0; });
  return *failure_;
}

// Throws after the workers have ended, so that nothing is left on the disk when the caller gets the error.
void SliceIntake::throw_ended(Lock& lock) {
  for_adders_.wait(lock, [this] { return running_ == 0; });
  throw Error(*failure_);
}

}  // namespace weir
