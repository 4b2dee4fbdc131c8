// Slabs of a volume out of the memory of a device, behind the caller's back: each slab is cut into pieces of whole
// planes, which are copied in the caller's stream into slots; a thread waits for the copies and hands the values over.
//
// A slot is page-locked host memory, or, where device memory was granted, memory
// of the device: there a slab waits at the device's own speed, and crosses the
// bus in a stream of lower priority while the caller's stream goes on.
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
  /// Takes planes [z0, z0 + nz), x fastest, without gaps. Called by one thread, whose exception ends the object's work.
  using Arrived = std::function<void(std::int64_t z0, std::int64_t nz, const std::byte* values)>;

  /// A piece, of one plane at least, aims at so many bytes.
  static constexpr std::uint64_t kPieceBytes = 8ULL << 20U;
  /// Slots of page-locked memory; two where a plane is larger than kPieceBytes.
  static constexpr std::size_t kPinnedSlots = 4;

  /// For slabs of a volume of `extent` voxels on the current device, in the calling thread's context. `device_bytes`
  /// may be taken there, 0 for none; page-locked memory is kPinnedSlots pieces without it, and one piece with it.
  /// Throws Error(usage) where it holds no plane, and Error(io) where there is no room.
  DeviceSlabs(const Index3& extent, std::size_t value_bytes, std::uint64_t device_bytes, Arrived arrived);
  /// Waits for copies in progress; what arrives then is not handed over.
  ~DeviceSlabs();
  DeviceSlabs(const DeviceSlabs&) = delete;
  DeviceSlabs& operator=(const DeviceSlabs&) = delete;

  /// check_slab() for its device.
  void check(const DeviceValues& values) const { check_slab(values, device_); }

  /// Queues the copy of planes [z0, z0 + nz), whose first voxel is values.first, behind the work in `stream`. Waits
  /// while no slot is free. Work that is queued in `stream` afterwards may change the values. Any threads may call.
  /// Throws Error(usage) as check does, Error(io) where a copy failed, and what ended the work: then and later.
  void add(std::int64_t z0, std::int64_t nz, const DeviceValues& values, cudaStream_t stream);

  /// Waits until all was handed over. Throws what ended the work.
  void finish();

 private:
  struct Slot {
    std::byte* memory;  // as the device sees it
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
  std::optional<PinnedMemory> pinned_;      // the slots, or, where they are on the device, one piece
  DeviceArray<std::byte> staged_;           // the slots, or empty
  std::optional<BackgroundStream> stream_;  // out of them
  std::vector<Slot> slots_;

  std::mutex mutex_;  // of all that follows
  std::condition_variable changed_;
  std::vector<std::size_t> free_;
  std::deque<Piece> pieces_;  // queued; the first is being handed over
  std::optional<Error> failure_;
  bool stopping_ = false;
  std::jthread worker_;  // last: it uses all of the above
};

}  // namespace weir
