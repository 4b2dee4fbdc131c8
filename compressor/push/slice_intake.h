// Gathers slabs of a volume, which come in any order from any thread, into slices: boxes of one layer of leaves, in a
// bounded number of buffers. Complete slices go to workers of its own. Where all buffers hold incomplete slices, the
// one that was added to least recently is parked.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <thread>
#include <vector>

#include "format/base/error.h"
#include "ingest/plan/block_plan.h"
#include "ingest/plan/page_buffer.h"
#include "ingest/plan/strided_copy.h"

namespace weir {

/// Planes of a slice: bit i is its plane i, counted from its lowest voxel.
using PlaneMask = std::uint8_t;

/// What becomes of slices, on the workers' threads. `values` are the slice's voxels as they were handed over, x
/// fastest. An exception ends the intake.
struct SliceSink {
  /// All planes are there: those of `parked` where park was given them, the others in `values`.
  std::function<void(std::int64_t slice, PlaneMask parked, std::span<std::byte> values)> complete;
  /// Keeps the planes of `planes`, which were not parked before.
  std::function<void(std::int64_t slice, PlaneMask planes, std::span<const std::byte> values)> park;
  /// Called once, by the last worker, after an exception: nothing of it will be called again.
  std::function<void()> abandon;
};

/// How much the intake may use.
struct IntakeRoom {
  std::size_t buffers = 1;  ///< each of a slice; at least 1
  std::size_t workers = 1;  ///< threads; at least 1
};

class SliceIntake {
 public:
  /// `plan` cuts the volume into slices, one leaf deep, of values of `value_bytes`.
  SliceIntake(const BlockPlan& plan, std::size_t value_bytes, const IntakeRoom& room, SliceSink sink);
  /// Stops the workers once they have finished their present slices.
  ~SliceIntake();
  SliceIntake(const SliceIntake&) = delete;
  SliceIntake& operator=(const SliceIntake&) = delete;

  /// Takes whole planes of the volume, each once. May be called by several threads; waits while all buffers are in use
  /// and the workers are freeing one. Throws what ended the workers, as they are where it cannot take all of the slab.
  void add(const StridedVoxels& slab);

  /// Waits until all slices, which are complete, went through the sink, and gives the memory back. Throws what ended
  /// the workers. Nothing may be added any more.
  void finish();

  /// Throws what ended the workers, where something did.
  void check();

  /// Ends the intake with `error`, as an exception of the sink does, unless it has ended already; returns the error
  /// that ended it.
  Error fail(const Error& error);

 private:
  struct Slice {
    std::byte* values;
    PlaneMask planes = 0;        // in `values`, whole
    int adding = 0;              // threads that copy into it
    bool parking = false;        // is being written out
    std::uint64_t last_use = 0;  // of all slices' uses
  };
  struct Work {
    std::int64_t slice;
    std::byte* values;
  };
  using Lock = std::unique_lock<std::mutex>;

  void stop();
  void copy(const StridedVoxels& slab);
  void work();
  void work_until_the_end(Lock& lock);
  std::optional<std::int64_t> slice_to_park() const;
  void complete_next(Lock& lock);
  void park(Lock& lock, std::int64_t index);
  Slice& open(Lock& lock, std::int64_t index);
  void close(std::int64_t index, Slice& slice, PlaneMask planes);
  void give_back(std::byte* values);
  [[noreturn]] void throw_ended(Lock& lock);
  PlaneMask all_planes(std::int64_t index) const;
  std::span<std::byte> values_of(std::int64_t index, std::byte* values) const;

  BlockPlan plan_;
  std::size_t value_bytes_;
  SliceSink sink_;
  PageBuffer memory_;
  std::vector<std::byte*> free_;   // buffers; the last one used is the warmest
  std::vector<PlaneMask> parked_;  // by slice

  std::mutex mutex_;
  std::condition_variable for_workers_;
  std::condition_variable for_adders_;
  std::map<std::int64_t, Slice> open_;
  std::deque<Work> complete_;
  std::uint64_t uses_ = 0;
  std::size_t waiting_ = 0;  // threads that need a buffer
  std::size_t running_ = 0;  // workers
  bool finishing_ = false;
  bool stopping_ = false;
  std::optional<Error> failure_;
  std::vector<std::jthread> workers_;  // last: they use all of the above
};

}  // namespace weir
