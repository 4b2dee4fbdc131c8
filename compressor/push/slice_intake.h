// Gathers slabs of a volume, which come in any order from any thread, into slices: boxes of one layer of leaves, in a
// bounded number of buffers. The intake's own workers process complete slices. If all buffers hold incomplete slices,
// the slice that was added to least recently is parked.
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

/// A set of planes of a slice: bit i is plane i, counted from the slice's lowest voxel.
using PlaneMask = std::uint8_t;

/// The functions that the workers' threads call for slices. `values` are the slice's voxels as they were handed over, x
/// fastest. An exception ends the intake.
struct SliceSink {
  /// Called when all planes of a slice are there. park() was given the planes of `parked`; the others are in `values`.
  std::function<void(std::int64_t slice, PlaneMask parked, std::span<std::byte> values)> complete;
  /// Keeps the planes of `planes`. None of them was parked before.
  std::function<void(std::int64_t slice, PlaneMask planes, std::span<const std::byte> values)> park;
  /// Called once by the last worker, after an exception. No function of the sink is called again.
  std::function<void()> abandon;
};

/// The resources that the intake may use.
struct IntakeRoom {
  std::size_t buffers = 1;  ///< each of a slice; at least 1
  std::size_t workers = 1;  ///< threads; at least 1
};

class SliceIntake {
 public:
  /// `plan` cuts the volume into slices of one leaf layer. A value has `value_bytes`.
  SliceIntake(const BlockPlan& plan, std::size_t value_bytes, const IntakeRoom& room, SliceSink sink);
  /// Stops the workers once they have finished their present slices.
  ~SliceIntake();
  SliceIntake(const SliceIntake&) = delete;
  SliceIntake& operator=(const SliceIntake&) = delete;

  /// Takes whole planes of the volume, each once. Several threads may call it. Waits while all buffers are in use and
  /// the workers are freeing one. If it cannot take the whole slab, it ends the workers. Throws the error that ended
  /// the workers.
  void add(const StridedVoxels& slab);

  /// Waits until all slices have gone through the sink, and frees the memory. All slices must be complete, and nothing
  /// may be added afterwards. Throws the error that ended the workers.
  void finish();

  /// Throws the error that ended the workers, if there is one.
  void check();

  /// Ends the intake with `error`, as an exception of the sink does, unless it has ended already. Returns the error
  /// that ended it.
  Error fail(const Error& error);

 private:
  struct Slice {
    std::byte* values;
    PlaneMask planes = 0;        // in `values`, whole
    int adding = 0;              // threads that copy into it
    bool parking = false;        // the sink is parking it
    std::uint64_t last_use = 0;  // the value of uses_ at that time
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
