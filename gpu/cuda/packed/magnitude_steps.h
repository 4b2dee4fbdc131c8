// The third step of decoding packed blocks. One thread per block takes the magnitudes from its stream and writes
// them, by place, to the memory of the block's values; the next step reads them there. It runs twice: for magnitudes
// of 16 bits, and for magnitudes of 32 bits of the blocks that did not fit the first pass. For host and device.
#pragma once

#include <cstddef>
#include <cstdint>

#include "format/base/host_device.h"
#include "format/packed/block_decode.h"
#include "gpu/cuda/packed/decode_call.h"
#include "gpu/cuda/packed/packed_view.h"
#include "gpu/cuda/packed/scan_steps.h"
#include "gpu/cuda/packed/shared_coder.h"
#include "gpu/cuda/packed/stream_queue.h"

namespace weir {

namespace decode_detail {

// A thread's shared memory: its window, then its ring. The window has an odd number of 4-byte units, so that threads
// that look at the same slot use different banks.
template <class Slot>
inline constexpr unsigned kWindowBytes = ((kScanSteps.slots * static_cast<unsigned>(sizeof(Slot)) + 3) / 4 | 1U) * 4;
template <class Slot>
inline constexpr unsigned kOwnBytes = kWindowBytes<Slot> + StreamQueue::kBytes;

// The magnitudes that later places still need. They begin at byte `own` of the shared memory.
template <class Slot>
class Window {
 public:
  WEIR_HOST_DEVICE Window(unsigned char* shared, unsigned own) : shared_(shared), own_(own) { slot<0>(0) = 0; }

  WEIR_HOST_DEVICE std::uint32_t sum(std::uint32_t slots) const {
    return static_cast<std::uint32_t>(slot<0>(slots)) + slot<1>(slots) + slot<2>(slots);
  }
  WEIR_HOST_DEVICE void set(std::uint32_t slots, std::uint32_t magnitude) {
    if constexpr (sizeof(Slot) > 2) magnitude = magnitude < kMostOfNeighbour ? magnitude : kMostOfNeighbour;
    slot<3>(slots) = static_cast<Slot>(magnitude);
  }

 private:
  template <unsigned kByte>
  WEIR_HOST_DEVICE Slot& slot(std::uint32_t slots) const {
    constexpr unsigned kUnit = sizeof(Slot) / 2;
#if defined(__CUDA_ARCH__)
    const unsigned at = __dp4a(slots, kUnit << 8 * kByte, own_);
#else
    const unsigned at = own_ + kUnit * (slots >> 8 * kByte & 255U);
#endif
    return *reinterpret_cast<Slot*>(shared_ + at);
  }

  unsigned char* shared_;
  unsigned own_;
};

// Interleaved coders, and the words that they read.
struct Coders {
  std::uint32_t first = kLeastState;
  std::uint32_t second = kLeastState;
  StreamQueue words;
};

// Counts of decoded magnitudes. If `over` is not zero, a magnitude had more bits than a Slot.
struct Counted {
  std::uint32_t nonzero = 0;
  std::uint32_t half = 0;  // nonzero magnitudes before place 256
  std::uint32_t over = 0;
};

template <class Slot>
WEIR_HOST_DEVICE inline std::uint32_t decode_place(const ScanStep& step, const SharedTables& tables, bool residual,
                                                   std::uint32_t& x, StreamQueue& words, Window<Slot>& window,
                                                   Counted& counted, std::int32_t places_left) {
  constexpr unsigned kBits = 8 * sizeof(Slot);
  const std::uint32_t t = (step.rule & 0xFFFFU) * window.sum(step.slots);
  const std::uint32_t level = tables.level(t);
  std::uint32_t m = tables.symbol(x, (level & ~255U) + (residual ? kResidualContexts : step.rule >> 16U), words);
  if (m == kEscape) [[unlikely]] {
    words.fill_up(2 * places_left + 5);
    const unsigned length = words.take(x, 5);
    m = kEscape - 1 + (1U << length) + words.bypass(x, length);
    if constexpr (kBits < 32) counted.over |= m >> kBits;
  }
  unsigned extra = level & 255U;
  if (extra > 0) {
    if (t >= kLevelSums) extra = extra_bits(t);
    counted.over |= m >> (kBits - extra);
    m = m << extra | words.take(x, extra);
  }
  counted.nonzero += m != 0 ? 1 : 0;
  window.set(step.slots, m);
  return m;
}

// Decodes magnitudes as decode_magnitudes() of tests/format/packed/plain_decode.h does. Writes one run of them after
// the other to `out`.
template <class Slot>
WEIR_HOST_DEVICE inline Counted decode_magnitudes(const ScanSteps& steps, const SharedTables& tables, bool residual,
                                                  unsigned end, Coders& coders, Window<Slot> window, Quad* out,
                                                  std::uint8_t* before) {
  constexpr unsigned kQuads = kRun * sizeof(Slot) / sizeof(Quad);
  const bool two = states_of(end) == 2;
  Counted counted;
  for (unsigned run = 0; run < kEndUnit / kRun * end; ++run) {
    if (run == 256 / kRun) counted.half = counted.nonzero;
    before[run] = static_cast<std::uint8_t>(counted.nonzero - counted.half);
    coders.words.refill();
    Quad quads[kQuads];
    WEIR_UNROLL
    for (unsigned k = 0; k < kRun; k += 2) {
      const ScanStep* step = steps.of + run * kRun + k;
      std::uint32_t even = 0;
      if (k > 0 || run > 0) {
        even = decode_place(step[0], tables, residual, coders.first, coders.words, window, counted,
                            static_cast<std::int32_t>(kRun - 1 - k));
      }
      if (!two) coders.second = coders.first;
      const std::uint32_t odd = decode_place(step[1], tables, residual, coders.second, coders.words, window, counted,
                                             static_cast<std::int32_t>(kRun - 2 - k));
      if (!two) coders.first = coders.second;
      if constexpr (kQuads == 1) {
        quads[0].of[k / 2] = (even & 0xFFFFU) | odd << 16U;
      } else {
        quads[k / 4].of[k % 4] = even;
        quads[k / 4].of[k % 4 + 1] = odd;
      }
    }
    WEIR_UNROLL
    for (unsigned q = 0; q < kQuads; ++q) out[run * kQuads + q] = quads[q];
  }
  if (!two) coders.second = kLeastState;
  return counted;
}

enum class Outcome : std::uint8_t { decoded, wide, damaged };

// Does what decode_transform() and decode_lattice() of block_decode.cpp do up to the magnitudes, and the checks after
// them.
template <class Slot>
WEIR_HOST_DEVICE Outcome decode_stream(const DecodeCall& call, const FoundStream& found, const ScanSteps& steps,
                                       const SharedTables& tables, unsigned char* shared, unsigned own, Quad* out,
                                       BlockTask& task) {
  using namespace packed_detail;
  const BlockConstants& constants = call.view.constants;
  const bool residual = task.kind == TaskKind::lattice;
  const std::byte* front = found.data + 1;
  unsigned number_bits;
  std::int32_t step = 0;
  if (residual) {
    LatticeHead head;
    if (!read_lattice_head(constants, found.data, found.bytes, head)) return Outcome::damaged;
    task.predictor = static_cast<std::uint8_t>(head.predictor);
    task.ordered = head.kind == LatticeKind::ordered;
    task.value = head.minimum;
    task.step = head.quantum;
    number_bits = head.base_bits;
    front = head.front;
  } else if (!read_step(constants, found.means, found.data, step, number_bits)) {
    return Outcome::damaged;
  }
  const std::byte* stream_end = found.data + found.bytes;
  const auto front_bytes = static_cast<std::uint32_t>(stream_end - front);
  BitReader bits(front, front_bytes);
  const unsigned end = residual ? bits.read(6) : bits.read(5) + 1;
  CodedNumber number;
  const std::byte* front_end = stream_end;
  Counted counted;
  if (end == 0) {
    number.code = bits.read(number_bits);
  } else {
    const unsigned states = states_of(end);
    const unsigned flags = bits.read(states);
    if (bits.bytes_used() > front_bytes) return Outcome::damaged;
    StreamStates starts;
    if (!starts.start(front + bits.bytes_used(), stream_end, states, flags)) return Outcome::damaged;
    Coders coders;
    coders.first = starts.state(0);
    coders.second = starts.state(1);
    coders.words.start(front + bits.bytes_used(), starts.at(), shared + own + kWindowBytes<Slot>);
    counted = decode_magnitudes(steps, tables, residual, end, coders, Window<Slot>(shared, own), out, task.before);
    if (counted.over != 0) return sizeof(Slot) < 4 ? Outcome::wide : Outcome::damaged;
    if (coders.first >> 16U != 1 || coders.second >> 16U != 1) return Outcome::damaged;
    number = read_number(bits, states, coders.first, coders.second, counted.nonzero, number_bits);
    front_end = coders.words.at();
  }
  task.bytes = front;
  task.first_sign = bits.bits_used();
  task.early = number.early;
  if (front_end - front < static_cast<std::ptrdiff_t>((bits.bits_used() + number.early + 7) / 8)) {
    return Outcome::damaged;
  }
  task.payload = number.payload;
  task.limit = static_cast<std::uint16_t>(kEndUnit * end);
  task.half = static_cast<std::uint16_t>(counted.half);
  task.base = number.code;
  if (!residual) {
    task.step = step_size(step);
    task.value = decode_mean(found.means, step, number.code);
  }
  return Outcome::decoded;
}

// The blocks of a pass: those of the order from `first` on, then those that the narrow pass has left.
struct PassBlocks {
  const std::uint32_t* order = nullptr;
  const std::uint32_t* overflown = nullptr;
  std::uint32_t ordered = 0;
  std::uint32_t count = 0;

  WEIR_HOST_DEVICE std::uint32_t at(std::uint32_t n) const { return n < ordered ? order[n] : overflown[n - ordered]; }
};

WEIR_HOST_DEVICE inline PassBlocks wide_blocks(const DecodeCall& call) {
  const CallCounts& counts = *call.counts;
  const std::uint32_t ordered = call.count() - counts.narrow;
  return {call.order + counts.narrow, call.overflown, ordered, ordered + counts.overflown};
}

}  // namespace decode_detail

/// Returns the bytes of a group's shared memory, which lies at a multiple of 16.
template <class Slot>
WEIR_HOST_DEVICE constexpr unsigned magnitude_bytes(unsigned threads) {
  return decode_detail::SharedTables::kBytes + threads * decode_detail::kOwnBytes<Slot>;
}

/// Runs in each thread of a group. Slot is std::uint16_t in the narrow pass and std::uint32_t in the wide pass.
template <class Slot, class Thread>
WEIR_HOST_DEVICE void take_magnitudes(const Thread& thread, const DecodeCall& call, const ScanSteps& steps,
                                      unsigned char* shared) {
  using namespace decode_detail;
  constexpr bool kWide = sizeof(Slot) > 2;
  PassBlocks pass{call.order, nullptr, call.counts->coded, call.counts->coded};
  if constexpr (kWide) pass = wide_blocks(call);
  if (thread.group() * kWarp >= pass.count) return;
  if (kWide && thread.group() == 0 && thread.index() == 0) thread.add(call.totals + 1, pass.count);
  SharedTables tables(shared);
  tables.load(thread, call.tables);
  thread.meet();
  const unsigned own = SharedTables::kBytes + thread.index() * kOwnBytes<Slot>;
  const std::uint32_t warp = thread.index() / kWarp * thread.groups() + thread.group();  // spread over the groups
  const std::uint32_t warps = thread.count() / kWarp * thread.groups();
  for (std::uint32_t n = warp * kWarp + thread.index() % kWarp; n < pass.count; n += warps * kWarp) {
    const std::uint32_t i = pass.at(n);
    BlockTask& task = call.tasks[i];
    auto* out = reinterpret_cast<Quad*>(call.values + std::size_t{512} * i);
    const FoundStream found = find_stream(call.view, call.blocks[i]);
    const Outcome outcome = decode_stream<Slot>(call, found, steps, tables, shared, own, out, task);
    if (outcome == Outcome::wide) {
      task.wide = true;
      call.overflown[thread.add(&call.counts->overflown, 1)] = i;
    } else if (outcome == Outcome::damaged) {
      task.kind = TaskKind::fill;
      task.value = not_a_number();
      thread.add(call.totals, 1);
    }
  }
}

}  // namespace weir
