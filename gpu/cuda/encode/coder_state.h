// What all boxes share whose blocks a device surveys and encodes: its tables, memory that is used again, and whether it
// has failed.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "format/base/error.h"
#include "format/packed/block_encode.h"
#include "gpu/cuda/encode/digest_steps.h"
#include "gpu/cuda/encode/encode_call.h"
#include "gpu/cuda/encode/encoder_tables.h"
#include "gpu/cuda/encode/reused_memory.h"
#include "gpu/cuda/push/background_stream.h"
#include "gpu/cuda/runtime/current_device.h"
#include "gpu/cuda/runtime/device_array.h"

namespace weir {

/// What a box that is loaded takes.
struct BoxMemory {
  BackgroundStream stream;
  GrowingArray<float> values;
  GrowingArray<BlockFigures> figures;
  GrowingArray<RungCost> costs;
  GrowingArray<NearCost> near;
  GrowingPinned pinned;
  // Of resident blocks.
  GrowingArray<BlockSummary> summaries;
  GrowingArray<std::uint32_t> wanted;
  GrowingPinned wanted_values;
};

/// What a call that encodes takes.
struct StreamMemory {
  BackgroundStream stream;
  GrowingArray<StreamAsk> asks;
  GrowingArray<StreamState> states;
  GrowingArray<std::uint32_t> coded;
  GrowingArray<std::uint16_t> words;
  GrowingArray<float> decoded;
  GrowingArray<std::byte> out;
  GrowingArray<std::uint8_t> made;
  // Of resident blocks.
  GrowingArray<LeafRecord> records;
  GrowingArray<Digest> sources;
  GrowingPinned pinned;
};

struct CoderState {
  /// On `device`, the current one, and in the calling thread's context, whichever thread calls later. `most_boxes` are
  /// worked on at a time, at most. What goes wrong is told to `say`, once. Throws Error(io).
  CoderState(int device, std::size_t most_boxes, std::function<void(const Error&)> say)
      : context(device), failed(std::move(say)), costs(1), codes(1), digests(1), boxes(most_boxes) {
    std::vector<CostTables> host_costs(1);
    std::vector<CodeTables> host_codes(1);
    make_encoder_tables(built_in_tables(), host_costs[0], host_codes[0]);
    costs.upload(host_costs);
    codes.upload(host_codes);
    digests.upload(std::vector<DigestTables>(1));
  }

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
  /// What `call` returns, or nothing where it or an earlier one has failed.
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

/// Memory of `context` that goes back to its pool, once its stream has no more work.
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
