// The first two steps of decoding packed blocks: find the kind of each block, and an order that gives neighbouring
// threads similar streams. For host and device.
#pragma once

#include <cstdint>

#include "format/base/host_device.h"
#include "format/packed/block_decode.h"
#include "gpu/cuda/packed/decode_call.h"
#include "gpu/cuda/packed/packed_view.h"

namespace weir {

namespace decode_detail {

// Fills the task of a block, completely if the block is not coded. Returns false if its stream is damaged.
WEIR_HOST_DEVICE inline bool look_at_block(const PackedView& view, const FoundStream& found, TaskHead& task) {
  using namespace packed_detail;
  task.kind = TaskKind::fill;
  task.bin = kFillBin;
  task.value = found.value;
  if (found.damaged) return false;
  if (found.data == nullptr) return true;
  if (found.bytes < 2) return false;
  switch (static_cast<PackedKind>(static_cast<unsigned>(found.data[0]) & 3U)) {
    case PackedKind::mean:
      return read_mean(view.constants, found.means, found.data, found.bytes, task.value);
    case PackedKind::transform: {
      const unsigned end = (static_cast<unsigned>(found.data[1]) & 31U) + 1;
      task.kind = TaskKind::transform;
      task.bin = static_cast<std::uint8_t>(2 * (kEnds - end));
      return true;
    }
    case PackedKind::lattice: {
      LatticeHead head;
      if (!read_lattice_head(view.constants, found.data, found.bytes, head)) return false;
      BitReader bits(head.front, static_cast<std::uint32_t>(found.data + found.bytes - head.front));
      const unsigned end = bits.read(6);
      if (end > kEnds) return false;
      task.kind = TaskKind::lattice;
      task.wide = head.kind == LatticeKind::ordered;
      task.bin = static_cast<std::uint8_t>(task.wide ? kWideBins + kEnds - end : 2 * (kEnds - end) + 1);
      return true;
    }
    case PackedKind::raw:
      break;
  }
  bool uniform;
  if (!read_raw_head(found.data, found.bytes, uniform)) return false;
  task.kind = uniform ? TaskKind::fill : TaskKind::raw;
  task.bytes = found.data + 1;
  if (uniform) task.value = load_bytes<float>(task.bytes);
  return true;
}

}  // namespace decode_detail

/// The first step: fills the tasks and counts the bins. `shared` has kBins elements.
template <class Thread>
WEIR_HOST_DEVICE void look_at_blocks(const Thread& thread, const DecodeCall& call, std::uint32_t* shared) {
  using namespace decode_detail;
  for (unsigned b = thread.index(); b < kBins; b += thread.count()) shared[b] = 0;
  thread.meet();
  const std::uint32_t count = call.count();
  for (std::uint32_t i = thread.group() * thread.count() + thread.index(); i < count;
       i += thread.groups() * thread.count()) {
    TaskHead task;
    if (!look_at_block(call.view, find_stream(call.view, call.blocks[i]), task)) {
      task = {nullptr, not_a_number(), TaskKind::fill, kFillBin, false};
      thread.add(call.totals, 1);
    }
    static_cast<TaskHead&>(call.tasks[i]) = task;
    thread.add(shared + task.bin, 1);
  }
  thread.meet();
  for (unsigned b = thread.index(); b < kBins; b += thread.count()) {
    if (shared[b] > 0) thread.add(call.counts->bin + b, shared[b]);
  }
}

/// The second step: makes the order. `shared` has 2 kBins elements.
template <class Thread>
WEIR_HOST_DEVICE void order_blocks(const Thread& thread, const DecodeCall& call, std::uint32_t* shared) {
  using namespace decode_detail;
  CallCounts& counts = *call.counts;
  std::uint32_t* next = shared + kBins;
  const std::uint32_t count = call.count();
  for (std::uint32_t first = thread.group() * thread.count(); first < count;
       first += thread.groups() * thread.count()) {
    for (unsigned b = thread.index(); b < kBins; b += thread.count()) shared[b] = 0;
    thread.meet();
    const std::uint32_t i = first + thread.index();
    unsigned bin = 0;
    std::uint32_t rank = 0;
    if (i < count) {
      bin = call.tasks[i].bin;
      rank = thread.add(shared + bin, 1);
    }
    thread.meet();
    for (unsigned b = thread.index(); b < kBins; b += thread.count()) {
      if (shared[b] == 0) continue;
      std::uint32_t start = 0;
      for (unsigned other = 0; other < b; ++other) start += counts.bin[other];
      next[b] = start + thread.add(counts.taken + b, shared[b]);
    }
    thread.meet();
    if (i < count) call.order[next[bin] + rank] = i;
  }
  if (thread.group() == 0 && thread.index() == 0) {
    std::uint32_t start = 0;
    for (unsigned b = 0; b < kFillBin; ++b) start += counts.bin[b];
    counts.coded = start;
    counts.narrow = start + counts.bin[kFillBin];
  }
}

}  // namespace weir
