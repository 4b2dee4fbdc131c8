// What all boxes share that a device surveys and encodes: the coder's tables, reused memory, and whether the device
// has failed.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>

#include "format/base/error.h"
#include "gpu/cuda/encode/digest_steps.h"
#include "gpu/cuda/encode/encode_call.h"
#include "gpu/cuda/encode/encoder_tables.h"
#include "gpu/cuda/encode/reused_memory.h"
#include "gpu/cuda/load/copy_event.h"
#include "gpu/cuda/push/background_stream.h"
#include "gpu/cuda/runtime/current_device.h"
#include "gpu/cuda/runtime/device_array.h"

namespace weir {

/// The memory of a loaded box.
struct BoxMemory {
  BackgroundStream stream;
  CopyEvent done;  // the results of the last call have arrived
  GrowingArray<float> values;
  GrowingArray<BlockFigures> figures;
  GrowingArray<RungCost> costs;
  GrowingArray<NearCost> near;
  GrowingPinned pinned;
  // Only for resident blocks.
  GrowingArray<BlockRow> rows;
  GrowingArray<BlockSummary> summaries;
  GrowingArray<std::uint32_t> wanted;
  GrowingPinned wanted_values;
};

/// The memory of a call that encodes.
struct StreamMemory {
  BackgroundStream stream;
  CopyEvent done;  // the results have arrived
  GrowingArray<StreamAsk> asks;
  GrowingArray<StreamState> states;
  GrowingArray<std::uint32_t> coded;
  GrowingArray<std::uint16_t> words;
  GrowingArray<float> decoded;
  GrowingArray<std::byte> out;
  GrowingArray<std::uint8_t> made;
  // Only for resident blocks.
  GrowingArray<LeafRecord> records;
  GrowingArray<Digest> sources;
  GrowingPinned pinned;

  /// Makes room for the streams of `blocks` blocks with `bytes` bytes together, except for what comes back to the
  /// host. If `resident` is set, also for their records. Throws Error(io).
  void hold(std::size_t blocks, std::size_t bytes, bool resident) {
    asks.at_least(blocks);
    states.at_least(blocks);
    coded.at_least(512 * blocks);
    words.at_least(bytes / 2 + blocks + 1);
    decoded.at_least(512 * blocks);
    out.at_least(bytes);
    made.at_least(blocks);
    if (!resident) return;
    records.at_least(blocks);
    sources.at_least(blocks);
  }
  /// Minimum room for a resident volume. Regions have different numbers of streams; most fit into this room, so the
  /// memory seldom grows.
  static constexpr std::size_t kRegionBlocks = 4096;
  static constexpr std::size_t kRegionBytes = std::size_t{2} << 20U;  // four bits a voxel
};

struct CoderState {
  /// Uses `device`, the current device, and the calling thread's context, whichever thread calls later. At most
  /// `most_boxes` boxes are worked on at a time. Passes the first failure to `say`, once. Throws Error(io).
  CoderState(int device, std::size_t most_boxes, std::function<void(const Error&)> say);
  ~CoderState() {
    free_on(context, [&] {
      boxes.clear();
      streams.clear();
      costs = {};
      codes = {};
      digests = {};
    });
  }
  CoderState(const CoderState&) = delete;
  CoderState& operator=(const CoderState&) = delete;

  void fail(const Error& error) {
    if (!broken.exchange(true) && failed) failed(error);
  }
  /// Returns what `call` returns, or nothing if it or an earlier call has failed.
  template <class Call>
  auto attempt(const Call& call) -> decltype(call()) {
    if (broken) return {};
    try {
      const KeptDevice kept(context);
      return call();
    } catch (const Error& error) {
      fail(error);
      return {};
    }
  }

  const SharedContext context;
  std::function<void(const Error&)> failed;
  std::atomic<bool> broken{false};
  DeviceArray<CostTables> costs;
  DeviceArray<CodeTables> codes;
  DeviceArray<DigestTables> digests;
  MemoryPool<BoxMemory> boxes;
  MemoryPool<StreamMemory> streams;
};

/// Memory of `context` that goes back to its pool as soon as its stream has no more work.
template <class Memory>
class Lent {
 public:
  Lent(const SharedContext& context, MemoryPool<Memory>& pool, std::unique_ptr<Memory> memory)
      : context_(context), pool_(pool), memory_(std::move(memory)) {}
  ~Lent() {
    free_on(context_, [&] {
      if (cudaStreamSynchronize(memory_->stream.get()) != cudaSuccess) cudaGetLastError();
    });
    pool_.give_back(std::move(memory_));
  }
  Lent(const Lent&) = delete;
  Lent& operator=(const Lent&) = delete;

  Memory& operator*() const { return *memory_; }
  Memory* operator->() const { return memory_.get(); }

 private:
  const SharedContext context_;
  MemoryPool<Memory>& pool_;
  std::unique_ptr<Memory> memory_;
};

}  // namespace weir
