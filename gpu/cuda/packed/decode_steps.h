// How the threads of a group decode packed blocks together, two steps for as many blocks as there are threads, both in
// shared memory: a thread a block takes the magnitudes out of its stream, all of a warp at the same place of the scan;
// then a warp a block transforms them. Blocks of other kinds than the transform, and those with magnitudes that shared
// memory has no room for, are left to one thread each.
//
// For host and device: a Thread says who runs, and lets the others of its warp or group catch up.
#pragma once

#include <cstddef>
#include <cstdint>

#include "format/base/host_device.h"
#include "format/packed/block_decode.h"
#include "gpu/cuda/packed/decode_layout.h"
#include "gpu/cuda/packed/packed_view.h"
#include "gpu/cuda/packed/shared_coder.h"

namespace weir {

/// What a call decodes.
struct DecodeCall {
  PackedView view;
  const PackedBlockId* blocks = nullptr;
  std::uint32_t count = 0;
  float* values = nullptr;            ///< 512 of each block
  std::uint32_t* left = nullptr;      ///< gets the indices of the blocks that are left to one thread
  std::uint32_t* counters = nullptr;  ///< damaged blocks, and how many are left
};

namespace decode_detail {

WEIR_HOST_DEVICE inline float not_a_number() { return __builtin_nanf(""); }

enum class Outcome : std::uint8_t { decoded, left, damaged };

/// Interleaved coders.
struct CoderStates {
  std::uint32_t first = kLeastState;
  std::uint32_t second = kLeastState;
};

// decode_magnitudes() of coefficient_decoder.h, into shared memory; `nonzero` gets how many are not zero.
WEIR_HOST_DEVICE inline Outcome decode_magnitudes(const ScanPlaces& scan, const SharedTables& tables,
                                                  CoderStates& states, StreamWords& words, unsigned end,
                                                  Magnitudes& magnitudes, std::uint32_t& nonzero) {
  const bool two = states_of(end) == 2;
  nonzero = 0;
  magnitudes.set(0, 0);
  for (unsigned place = 1; place < kEndUnit * end; ++place) {
    const bool second = two && (place & 1U) != 0;
    std::uint32_t x = second ? states.second : states.first;
    const std::uint16_t* near = scan.neighbour[place];
    const std::uint32_t t =
        scan.weight[place] *
        static_cast<std::uint32_t>(magnitudes.at(near[0]) + magnitudes.at(near[1]) + magnitudes.at(near[2]));
    std::uint32_t m = tables.symbol(x, scan.band[place] * kPackedLevels + tables.level(t), words);
    if (m == kEscape) {
      const unsigned length = words.bypass(x, 5);
      m = kEscape - 1 + (1U << length) + words.bypass(x, length);
    }
    const unsigned extra = extra_bits(t);
    if (extra > 0) {
      if (m >> (32 - extra) != 0) return Outcome::damaged;
      m = m << extra | words.bypass(x, extra);
    }
    if (second) {
      states.second = x;
    } else {
      states.first = x;
    }
    nonzero += m != 0 ? 1 : 0;
    if (!magnitudes.set(place, m)) return Outcome::left;
  }
  const bool ends_well = words.whole() && states.first >> 16U == 1 && states.second >> 16U == 1;
  return ends_well ? Outcome::decoded : Outcome::damaged;
}

// Gives the magnitudes their signs: the first `early` from `bits`, the others from the payload.
WEIR_HOST_DEVICE inline void add_signs(unsigned limit, std::uint32_t early, std::uint32_t payload, BitReader& bits,
                                       Magnitudes& magnitudes) {
  std::uint32_t seen = 0;
  std::uint32_t signs = 0;
  for (unsigned place = 1; place < limit; ++place) {
    if (magnitudes.at(place) == 0) continue;
    if (seen == early) signs = payload;
    if (seen < early && seen % 16 == 0) signs = bits.read(early - seen < 16 ? early - seen : 16);
    if ((signs & 1U) != 0) magnitudes.negate(place);
    signs >>= 1U;
    ++seen;
  }
}

// decode_transform() of block_decode.h up to the signed magnitudes and the mean.
WEIR_HOST_DEVICE inline Outcome decode_stream(const PackedView& view, const ScanPlaces& scan,
                                              const SharedTables& tables, const FoundStream& found,
                                              Magnitudes& magnitudes, BlockTask& task) {
  using namespace packed_detail;
  std::int32_t step;
  unsigned number_bits;
  if (!read_step(view.constants, found.means, found.data, step, number_bits)) return Outcome::damaged;
  const std::byte* front = found.data + 1;
  const std::uint32_t front_bytes = found.bytes - 1;
  BitReader bits(front, front_bytes);
  const unsigned end = bits.read(5) + 1;
  const unsigned states = states_of(end);
  const unsigned flags = bits.read(states);
  if (bits.bytes_used() > front_bytes) return Outcome::damaged;
  RansDecoder starts;
  if (!starts.start(front + bits.bytes_used(), found.data + found.bytes, states, flags)) return Outcome::damaged;
  CoderStates coders{starts.state(0), states == 2 ? starts.state(1) : kLeastState};
  StreamWords words = starts.words();
  std::uint32_t nonzero = 0;
  const Outcome outcome = decode_magnitudes(scan, tables, coders, words, end, magnitudes, nonzero);
  if (outcome != Outcome::decoded) return outcome;

  const CodedNumber number = read_number(bits, states, coders.first, coders.second, nonzero, number_bits);
  add_signs(kEndUnit * end, number.early, number.payload, bits, magnitudes);
  if (front + bits.bytes_used() > words.at()) return Outcome::damaged;
  task.step = step_size(step);
  task.value = decode_mean(found.means, step, number.code);
  task.limit = static_cast<std::uint16_t>(kEndUnit * end);
  return Outcome::decoded;
}

// Places of the coefficients that a lane begins with: two lines along z.
struct LanePlaces {
  std::uint16_t of[2][8];
};

WEIR_HOST_DEVICE inline LanePlaces lane_places(const BlockScan& scan, unsigned lane) {
  LanePlaces places;
  for (unsigned half = 0; half < 2; ++half) {
    for (unsigned k = 0; k < 8; ++k) places.of[half][k] = scan.place[8 * (lane + kWarp * half) + k];
  }
  return places;
}

// A whole warp calls it. `stage` has kStageFloats.
template <class Thread>
WEIR_HOST_DEVICE void transform_block(const Thread& thread, const BlockConstants& constants, const BlockTask& task,
                                      const Magnitudes& magnitudes, const LanePlaces& places, float* stage,
                                      float* out) {
  using namespace packed_detail;
  const unsigned lane = thread.index() % kWarp;
  float line[8];
  for (unsigned half = 0; half < 2; ++half) {
    const unsigned n = lane + kWarp * half;
    for (unsigned k = 0; k < 8; ++k) {
      const unsigned place = places.of[half][k];
      const std::int32_t m = place < task.limit ? magnitudes.at(place) : 0;
      line[k] = coefficient(static_cast<std::uint32_t>(m), constants, task.step);
    }
    inverse_transform_8(line);
    for (unsigned k = 0; k < 8; ++k) stage[9 * n + k] = line[k];
  }
  thread.meet_warp();
  for (unsigned half = 0; half < 2; ++half) {
    const unsigned n = lane + kWarp * half;
    float* first = stage + (n >> 3U) * 72 + (n & 7U);
    for (unsigned k = 0; k < 8; ++k) line[k] = first[9 * k];
    inverse_transform_8(line);
    for (unsigned k = 0; k < 8; ++k) first[9 * k] = line[k];
  }
  thread.meet_warp();
  for (unsigned half = 0; half < 2; ++half) {
    const unsigned n = lane + kWarp * half;
    const float* first = stage + n + (n >> 3U);
    for (unsigned k = 0; k < 8; ++k) line[k] = first[72 * k];
    inverse_transform_8(line);
    for (unsigned k = 0; k < 8; ++k) out[n + 64 * k] = clamp_to(constants, task.value + line[k]);
  }
  thread.meet_warp();
}

// The first step for one block: what the second one is to do.
template <class Thread>
WEIR_HOST_DEVICE BlockTask start_block(const Thread& thread, const DecodeCall& call, std::uint32_t i,
                                       const ScanPlaces& scan, const SharedTables& tables, Magnitudes magnitudes) {
  const FoundStream found = find_stream(call.view, call.blocks[i]);
  BlockTask task{0, found.value, 0, 0};
  Outcome outcome = found.damaged ? Outcome::damaged : Outcome::decoded;
  if (found.data != nullptr) {
    const bool transformed =
        found.bytes >= 2 && static_cast<StreamKind>(static_cast<unsigned>(found.data[0]) & 3U) == StreamKind::transform;
    outcome = transformed ? decode_stream(call.view, scan, tables, found, magnitudes, task) : Outcome::left;
  }
  if (outcome == Outcome::left) {
    call.left[thread.add(call.counters + 1, 1)] = i;
    return {};
  }
  if (outcome == Outcome::damaged) {
    thread.add(call.counters, 1);
    return {0, not_a_number(), 0, 0};
  }
  return task;
}

}  // namespace decode_detail

/// What each thread of a group does; `shared` are decode_layout(threads).bytes at a multiple of 16.
template <class Thread>
WEIR_HOST_DEVICE void decode_blocks(const Thread& thread, const DecodeCall& call, const ScanPlaces& scan_places,
                                    const BlockScan& scan, unsigned char* shared) {
  using namespace decode_detail;
  const unsigned threads = thread.count();
  const unsigned warp = thread.index() / kWarp;
  const DecodeLayout layout = decode_layout(threads);
  auto* tasks = reinterpret_cast<BlockTask*>(shared + layout.tasks);
  float* stage = reinterpret_cast<float*>(shared + layout.stage) + warp * kStageFloats;
  SharedTables tables(shared, layout);
  tables.fill(thread, scan, call.view.constants.tables);
  const LanePlaces places = lane_places(scan, thread.index() % kWarp);
  thread.meet();
  for (std::uint32_t first = thread.group() * threads; first < call.count; first += thread.groups() * threads) {
    const std::uint32_t i = first + thread.index();
    BlockTask own;
    if (i < call.count) {
      own = start_block(thread, call, i, scan_places, tables, Magnitudes(shared, layout, thread.index()));
    }
    tasks[thread.index()] = own;
    thread.meet();
    for (unsigned b = warp; b < threads; b += threads / kWarp) {
      const BlockTask task = tasks[b];
      if (task.skip != 0) continue;
      float* out = call.values + std::size_t{512} * (first + b);
      if (task.step > 0) {
        transform_block(thread, call.view.constants, task, Magnitudes(shared, layout, b), places, stage, out);
      } else {
        for (unsigned n = thread.index() % kWarp; n < 512; n += kWarp) out[n] = task.value;
      }
    }
    thread.meet();
  }
}

/// The blocks that decode_blocks has left, a thread each.
template <class Thread>
WEIR_HOST_DEVICE void decode_left(const Thread& thread, const DecodeCall& call, const BlockScan& scan) {
  const std::uint32_t count = call.counters[1];
  const std::uint32_t all = thread.groups() * thread.count();
  for (std::uint32_t n = thread.group() * thread.count() + thread.index(); n < count; n += all) {
    const std::uint32_t i = call.left[n];
    const FoundStream found = find_stream(call.view, call.blocks[i]);
    float* out = call.values + std::size_t{512} * i;
    if (decode_block_plain(call.view.constants, scan, found.means, found.data, found.bytes, out)) continue;
    for (unsigned k = 0; k < 512; ++k) out[k] = decode_detail::not_a_number();
    thread.add(call.counters, 1);
  }
}

}  // namespace weir
