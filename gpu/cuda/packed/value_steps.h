// The fourth step of decoding packed blocks: one warp per block makes values from the magnitudes that the third step
// has left in the memory of the values. For host and device.
#pragma once

#include <cstddef>
#include <cstdint>

#include "format/base/host_device.h"
#include "format/packed/block_decode.h"
#include "gpu/cuda/packed/decode_call.h"
#include "gpu/cuda/packed/magnitude_steps.h"

namespace weir {

/// Voxels ordered by the sum of their coordinates, as positions on a stage.
struct Diagonals {
  std::uint16_t voxel[512] = {};
  std::uint16_t first[23] = {};  ///< of each sum
};

/// Words of a warp's shared memory: lines of eight along z, each followed by a gap, so that no two lanes use the same
/// bank.
inline constexpr unsigned kStageWords = 576;

namespace decode_detail {

inline constexpr unsigned kStageX = 72;
inline constexpr unsigned kStageY = 9;

WEIR_HOST_DEVICE constexpr unsigned stage_of(unsigned index) { return index + (index >> 3U); }

constexpr Diagonals make_diagonals() {
  Diagonals made;
  unsigned count = 0;
  for (unsigned sum = 0; sum < 22; ++sum) {
    made.first[sum] = static_cast<std::uint16_t>(count);
    for (unsigned i = 0; i < 512; ++i) {
      if (packed_detail::axis_sum(i) == sum) made.voxel[count++] = static_cast<std::uint16_t>(stage_of(i));
    }
  }
  made.first[22] = 512;
  return made;
}

// The stage positions of a lane's coefficients or residuals, which are those of two runs.
struct LanePlaces {
  std::uint16_t of[2][kRun];
};

WEIR_HOST_DEVICE inline LanePlaces lane_places(const BlockScan& scan, unsigned lane) {
  LanePlaces places;
  for (unsigned half = 0; half < 2; ++half) {
    for (unsigned k = 0; k < kRun; ++k) {
      places.of[half][k] = static_cast<std::uint16_t>(stage_of(scan.index[kRun * (lane + kWarp * half) + k]));
    }
  }
  return places;
}

template <class Slot>
struct alignas(16) Run {
  Slot of[kRun];
};

// Returns the signs of a run's nonzero magnitudes; the first one is the lowest bit.
WEIR_HOST_DEVICE inline std::uint32_t signs_from(const BlockTask& task, std::uint32_t seen) {
  if (seen >= task.early) return task.payload >> ((seen - task.early) & 31U);
  const std::uint32_t bit = task.first_sign + seen;
  const std::uint32_t last = (task.first_sign + task.early - 1) >> 3U;
  std::uint32_t signs = static_cast<std::uint32_t>(task.bytes[bit >> 3U]);
  if (bit >> 3U < last) signs |= static_cast<std::uint32_t>(task.bytes[(bit >> 3U) + 1]) << 8U;
  signs >>= bit & 7U;
  const std::uint32_t rest = task.early - seen;
  return rest < kRun ? (signs & ((1U << rest) - 1U)) | task.payload << rest : signs;
}

// Calls put(stage, magnitude, negative) for each of a lane's places.
template <class Slot, class Put>
WEIR_HOST_DEVICE void for_lane_places(const BlockTask& task, const LanePlaces& places, unsigned lane,
                                      const float* values, const Put& put) {
  Run<Slot> magnitudes[2] = {};
  std::uint32_t seen[2] = {};
  WEIR_UNROLL
  for (unsigned half = 0; half < 2; ++half) {
    const unsigned run = lane + kWarp * half;
    if (kRun * run >= task.limit) continue;
    magnitudes[half] = reinterpret_cast<const Run<Slot>*>(values)[run];
    seen[half] = task.before[run] + (half > 0 ? task.half : 0U);
  }
  std::uint32_t signs[2] = {};
  WEIR_UNROLL
  for (unsigned half = 0; half < 2; ++half) {
    if (kRun * (lane + kWarp * half) < task.limit) signs[half] = signs_from(task, seen[half]);
  }
  WEIR_UNROLL
  for (unsigned half = 0; half < 2; ++half) {
    if (half > 0 && task.limit <= kRun * kWarp) {
      WEIR_UNROLL
      for (unsigned k = 0; k < kRun; ++k) put(places.of[half][k], 0, false);
      break;
    }
    WEIR_UNROLL
    for (unsigned k = 0; k < kRun; ++k) {
      const std::uint32_t m = magnitudes[half].of[k];
      put(places.of[half][k], m, m != 0 && (signs[half] & 1U) != 0);
      signs[half] >>= m != 0 ? 1U : 0U;
    }
  }
}

// Calls work(line) for each of a lane's lines along z, y or x: two lines per lane.
template <unsigned kAxis, class T, class Work>
WEIR_HOST_DEVICE void for_lane_lines(T* stage, unsigned lane, const Work& work) {
  constexpr unsigned kStride = kAxis == 0 ? kStageX : kAxis == 1 ? kStageY : 1;
  WEIR_UNROLL
  for (unsigned half = 0; half < 2; ++half) {
    const unsigned n = lane + kWarp * half;
    T* first = stage + (kAxis == 0 ? stage_of(n) : kAxis == 1 ? (n >> 3U) * kStageX + (n & 7U) : n * kStageY);
    T line[8];
    WEIR_UNROLL
    for (unsigned k = 0; k < 8; ++k) line[k] = first[k * kStride];
    work(line);
    WEIR_UNROLL
    for (unsigned k = 0; k < 8; ++k) first[k * kStride] = line[k];
  }
}

template <class Slot, class Thread>
WEIR_HOST_DEVICE void transform_block(const Thread& thread, const BlockConstants& constants, const BlockTask& task,
                                      const LanePlaces& places, float* stage, float* out) {
  using namespace packed_detail;
  const unsigned lane = thread.index() % kWarp;
  const float step = task.step;
  const float mean = task.value;
  for_lane_places<Slot>(task, places, lane, out, [&](unsigned at, std::uint32_t m, bool negative) {
    const float c = coefficient(m, constants, step);
    stage[at] = negative ? -c : c;
  });
  thread.meet_warp();
  const auto line = [](float(&values)[8]) { inverse_transform_8(values); };
  for_lane_lines<2>(stage, lane, line);
  thread.meet_warp();
  for_lane_lines<1>(stage, lane, line);
  thread.meet_warp();
  WEIR_UNROLL
  for (unsigned half = 0; half < 2; ++half) {
    const unsigned n = lane + kWarp * half;
    float values[8];
    WEIR_UNROLL
    for (unsigned k = 0; k < 8; ++k) values[k] = stage[stage_of(n) + k * kStageX];
    inverse_transform_8(values);
    WEIR_UNROLL
    for (unsigned k = 0; k < 8; ++k) out[n + 64 * k] = clamp_to(constants, mean + values[k]);
  }
  thread.meet_warp();
}

// undo_prediction() of lattice_codes.h by a warp, one diagonal after the other. Returns false if a code is too large.
template <class Sum, class Thread>
WEIR_HOST_DEVICE bool undo_by_diagonals(const Thread& thread, const Diagonals& diagonals, unsigned predictor,
                                        bool ordered, std::uint32_t* codes) {
  bool valid = true;
  for (unsigned sum = 1; sum < 22; ++sum) {
    for (unsigned n = diagonals.first[sum] + thread.index() % kWarp; n < diagonals.first[sum + 1]; n += kWarp) {
      const unsigned at = diagonals.voxel[n];
      const unsigned x = at / kStageX;
      const unsigned y = (at - x * kStageX) / kStageY;
      const unsigned z = at - x * kStageX - y * kStageY;
      std::uint32_t code = codes[at] + static_cast<std::uint32_t>(predict_at<Sum, kStageX, kStageY>(
                                           predictor, ordered, codes + at, x > 0, y > 0, z > 0));
      if (!ordered) {
        valid = valid && code >> 24U == 0;
        code &= (1U << 24U) - 1U;
      }
      codes[at] = code;
    }
    thread.meet_warp();
  }
  return valid;
}

template <class Slot, class Thread>
WEIR_HOST_DEVICE void lattice_block(const Thread& thread, const DecodeCall& call, const BlockTask& task,
                                    const LanePlaces& places, const Diagonals& diagonals, std::uint32_t* stage,
                                    float* out) {
  using namespace packed_detail;
  const unsigned lane = thread.index() % kWarp;
  for_lane_places<Slot>(task, places, lane, out, [&](unsigned at, std::uint32_t m, bool negative) {
    stage[at] = at == 0 ? task.base : negative ? 0U - m : m;
  });
  const float minimum = task.value;
  const float quantum = task.step;
  const bool ordered = task.ordered;
  thread.meet_warp();
  bool valid = ordered || task.base >> 24U == 0;
  if (task.predictor == 0) {
    const auto add_up = [](std::uint32_t(&codes)[8]) {
      WEIR_UNROLL
      for (unsigned k = 1; k < 8; ++k) codes[k] += codes[k - 1];
    };
    for_lane_lines<2>(stage, lane, add_up);
    thread.meet_warp();
    for_lane_lines<1>(stage, lane, add_up);
    thread.meet_warp();
    for_lane_lines<0>(stage, lane, add_up);
    thread.meet_warp();
  } else if (ordered) {
    undo_by_diagonals<std::int64_t>(thread, diagonals, task.predictor, true, stage);
  } else if (!undo_by_diagonals<std::int32_t>(thread, diagonals, task.predictor, false, stage)) {
    valid = false;
  }
  std::uint32_t all = 0;
  float values[16];
  WEIR_UNROLL
  for (unsigned k = 0; k < 16; ++k) {
    const std::uint32_t code = stage[stage_of(lane + kWarp * k)];
    all |= code;
    values[k] = ordered ? float_of_ordered(code) : lattice_value(call.view.constants, minimum, quantum, code);
  }
  const bool damaged = thread.any_of_warp(!valid || (!ordered && all >> 24U != 0));
  WEIR_UNROLL
  for (unsigned k = 0; k < 16; ++k) out[lane + kWarp * k] = damaged ? not_a_number() : values[k];
  if (damaged && lane == 0) thread.add(call.totals, 1);
}

struct alignas(16) FourFloats {
  float of[4];
};

WEIR_HOST_DEVICE inline void fill_block(unsigned lane, float value, float* out) {
  const FourFloats four{{value, value, value, value}};
  WEIR_UNROLL
  for (unsigned n = 0; n < 4; ++n) reinterpret_cast<FourFloats*>(out)[lane + kWarp * n] = four;
}

// Reads whole aligned units of four bytes.
WEIR_HOST_DEVICE inline void copy_raw_block(unsigned lane, const std::byte* bytes, float* out) {
  const std::size_t odd = reinterpret_cast<std::uintptr_t>(bytes) & 3U;
  const auto* from = reinterpret_cast<const std::uint32_t*>(bytes - odd);
  WEIR_UNROLL
  for (unsigned k = 0; k < 16; ++k) {
    const unsigned i = lane + kWarp * k;
    const std::uint64_t both = from[i] | static_cast<std::uint64_t>(odd > 0 ? from[i + 1] : 0U) << 32U;
    const auto bits = static_cast<std::uint32_t>(both >> (8 * odd));
    __builtin_memcpy(out + i, &bits, sizeof bits);
  }
}

// Makes the values of a block of the pass.
template <class Slot, class Thread>
WEIR_HOST_DEVICE void value_block(const Thread& thread, const DecodeCall& call, std::uint32_t i,
                                  const LanePlaces& places, const Diagonals& diagonals, void* stage) {
  const unsigned lane = thread.index() % kWarp;
  const BlockTask& task = call.tasks[i];
  if (task.wide != (sizeof(Slot) > 2)) return;
  float* out = call.values + std::size_t{512} * i;
  switch (task.kind) {
    case TaskKind::transform:
      transform_block<Slot>(thread, call.view.constants, task, places, static_cast<float*>(stage), out);
      break;
    case TaskKind::lattice:
      lattice_block<Slot>(thread, call, task, places, diagonals, static_cast<std::uint32_t*>(stage), out);
      break;
    case TaskKind::raw:
      copy_raw_block(lane, task.bytes, out);
      break;
    case TaskKind::fill:
      fill_block(lane, task.value, out);
      break;
  }
}

}  // namespace decode_detail

inline constexpr Diagonals kDiagonals = decode_detail::make_diagonals();

/// Runs in each thread of a group. `stage` is the warp's own memory, at a multiple of 4.
template <class Slot, class Thread>
WEIR_HOST_DEVICE void make_values(const Thread& thread, const DecodeCall& call, const BlockScan& scan,
                                  const Diagonals& diagonals, void* stage) {
  using namespace decode_detail;
  constexpr bool kWide = sizeof(Slot) > 2;
  PassBlocks pass{call.order, nullptr, call.counts->narrow, call.counts->narrow};
  if constexpr (kWide) pass = wide_blocks(call);
  const unsigned lane = thread.index() % kWarp;
  const LanePlaces places = lane_places(scan, lane);
  const std::uint32_t warp = thread.index() / kWarp * thread.groups() + thread.group();
  const std::uint32_t warps = thread.count() / kWarp * thread.groups();
  const std::uint32_t coded = kWide ? pass.count : call.counts->coded;
  // Fetches the next block's memory while this block's values are made.
  std::uint32_t i = warp < pass.count ? pass.at(warp) : 0;
  std::uint32_t next = warp + warps < pass.count ? pass.at(warp + warps) : 0;
  for (std::uint32_t n = warp; n < pass.count; n += warps) {
    const std::uint32_t after = n + 2 * warps < pass.count ? pass.at(n + 2 * warps) : 0;
    if (lane < 4) thread.prefetch(reinterpret_cast<const std::byte*>(call.tasks + next) + 32 * lane);
    if (n + warps < coded) {
      const auto* runs = reinterpret_cast<const Run<Slot>*>(call.values + std::size_t{512} * next);
      thread.prefetch(runs + lane);
      thread.prefetch(runs + lane + kWarp);
    }
    value_block<Slot>(thread, call, i, places, diagonals, stage);
    i = next;
    next = after;
  }
}

}  // namespace weir
