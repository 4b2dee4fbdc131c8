// Takes slabs of a volume from the memory of a device while the caller goes on. Each slab is cut into pieces of whole
// planes, which are copied in the caller's stream into slots. A thread waits for the copies and hands the values
// over.
//
// A slot is page-locked host memory, or device memory if the caller granted it. In device memory a slab is copied at
// the device's own speed, and crosses the bus in a stream of lower priority while the caller's stream goes on.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "format/base/error.h"
#include "format/base/index.h"
#include "gpu/cuda/load/copy_event.h"
#include "gpu/cuda/load/pinned_memory.h"
#include "gpu/cuda/push/background_stream.h"
#include "gpu/cuda/push/device_values.h"
#include "gpu/cuda/runtime/current_device.h"
#include "gpu/cuda/runtime/device_array.h"

namespace weir {

class DeviceSlabs {
 public:
  /// Receives planes [z0, z0 + nz), x fastest, without gaps. Called by one thread. Its exception ends the object's
  /// work.
  using Arrived = std::function<void(std::int64_t z0, std::int64_t nz, const std::byte* values)>;

  /// A piece has at least one plane and aims at this many bytes.
  static constexpr std::uint64_t kPieceBytes = 8ULL << 20U;
  /// Number of slots of page-locked memory; two if a plane is larger than kPieceBytes.
  static constexpr std::size_t kPinnedSlots = 4;

  /// For slabs of a volume of `extent` voxels on the current device, in the calling thread's context. At most
  /// `device_bytes` (0: none) are taken there. Page-locked memory is kPinnedSlots pieces without device memory, and
  /// one piece with it. Throws Error(usage) if `device_bytes` holds no plane, and Error(io) if there is no room.
  DeviceSlabs(const Index3& extent, std::size_t value_bytes, std::uint64_t device_bytes, Arrived arrived);
  /// Waits for copies in progress. Values that arrive then are not handed over.
  ~DeviceSlabs();
  DeviceSlabs(const DeviceSlabs&) = delete;
  DeviceSlabs& operator=(const DeviceSlabs&) = delete;

  /// Runs check_slab() for this object's device.
  void check(const DeviceValues& values) const { check_slab(values, device_); }

  /// Queues the copy of planes [z0, z0 + nz), whose first voxel is values.first, behind the work in `stream`. Waits
  /// while no slot is free. Work that is queued in `stream` afterwards may change the values. Any thread may call
  /// this. Throws Error(usage) as check() does, Error(io) if a copy failed, and, now and later, the exception that
  /// ended the work.
  void add(std::int64_t z0, std::int64_t nz, const DeviceValues& values, cudaStream_t stream);

  /// Waits until everything is handed over. Throws the exception that ended the work.
  void finish();

 private:
  struct Slot {
    std::byte* memory;  // the address for the device
    CopyEvent filled;
  };
  struct Piece {
    std::size_t slot;
    std::int64_t z0;
    std::int64_t nz;
  };
  using Lock = std::unique_lock<std::mutex>;

  void make_slots(std::uint64_t device_bytes);
  std::size_t take_slot();
  void copy(const Piece& piece, const DeviceValues& values, cudaStream_t stream);
  void work();
  void hand_over(const Piece& piece);
  void end_with(const Error& error);

  Index3 extent_;
  std::size_t value_bytes_;
  Arrived arrived_;
  int device_ = existing_current_device();
  SharedContext context_{device_};
  std::uint64_t plane_bytes_;
  std::int64_t piece_planes_;
  std::optional<PinnedMemory> pinned_;      // the slots; if they are on the device, one piece
  DeviceArray<std::byte> staged_;           // the slots, or empty
  std::optional<BackgroundStream> stream_;  // copies pieces from slots on the device
  std::vector<Slot> slots_;

  std::mutex mutex_;  // guards all members below
  std::condition_variable changed_;
  std::vector<std::size_t> free_;
  std::deque<Piece> pieces_;  // queued; the first piece is being handed over
  std::optional<Error> failure_;
  bool stopping_ = false;
  std::jthread worker_;  // last member, because it uses all of the above
};

}  // namespace weir
