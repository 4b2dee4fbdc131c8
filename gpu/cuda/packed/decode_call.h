// What a call that decodes packed blocks works on, and what its steps tell each other. For host and device.
#pragma once

#include <cstddef>
#include <cstdint>

#include "format/base/host_device.h"
#include "format/packed/coefficient_decoder.h"
#include "gpu/cuda/packed/packed_view.h"

namespace weir {

inline constexpr unsigned kWarp = 32;

namespace decode_detail {

WEIR_HOST_DEVICE inline float not_a_number() { return __builtin_nanf(""); }

// Coded blocks of the narrow pass in front, the longest first; then those of one value or none coded; then those of the
// wide pass, whose values do not fit 16 bits.
inline constexpr unsigned kEnds = 512 / kEndUnit;
inline constexpr unsigned kFillBin = 2 * kEnds + 2;
inline constexpr unsigned kWideBins = kFillBin + 1;
inline constexpr unsigned kBins = kWideBins + kEnds + 1;

enum class TaskKind : std::uint8_t { fill, raw, transform, lattice };

// Places whose nonzero magnitudes are counted together.
inline constexpr unsigned kRun = 8;

// What the first step finds out about a block.
struct alignas(16) TaskHead {
  const std::byte* bytes = nullptr;  // raw values; later what signs are read from, the first `early` of them
  float value = 0;                   // the only one; later a transform's mean or a lattice's minimum
  TaskKind kind = TaskKind::fill;
  std::uint8_t bin = 0;
  bool wide = false;  // of the wide pass
};

// And what the steps that decode magnitudes and make values of them know of it.
struct BlockTask : TaskHead {
  std::uint32_t first_sign = 0;  // bit of the bytes
  std::uint32_t early = 0;
  std::uint32_t payload = 0;  // the other signs
  float step = 0;             // of a transform; a lattice's quantum
  std::uint32_t base = 0;     // first code of a lattice
  std::uint16_t limit = 0;    // places from here on are zero
  std::uint16_t half = 0;     // nonzero magnitudes before place 256
  std::uint8_t predictor = 0;
  bool ordered = false;
  std::uint8_t before[512 / kRun] = {};  // nonzero magnitudes before a run, from place 0 or 256 on
};

// Counted on the device; cleared before a call.
struct CallCounts {
  std::uint32_t overflown = 0;  // blocks that the narrow pass has left
  std::uint32_t coded = 0;      // in front of the order
  std::uint32_t narrow = 0;     // those and the ones that are filled
  std::uint32_t bin[kBins] = {};
  std::uint32_t taken[kBins] = {};  // of each bin's blocks, those that have their position
};

}  // namespace decode_detail

/// What a call decodes.
struct DecodeCall {
  PackedView view;
  const unsigned char* tables = nullptr;  ///< SharedTables
  const BlockId* blocks = nullptr;
  std::uint32_t most = 0;
  const std::uint32_t* available = nullptr;  ///< where not null, *available - `first` blocks if they are fewer
  std::uint32_t first = 0;
  float* values = nullptr;                    ///< 512 of each block, at a multiple of 16 bytes
  decode_detail::BlockTask* tasks = nullptr;  ///< of each block
  std::uint32_t* order = nullptr;             ///< blocks by bin
  std::uint32_t* overflown = nullptr;         ///< blocks that the narrow pass has left
  decode_detail::CallCounts* counts = nullptr;
  std::uint32_t* totals = nullptr;  ///< damaged blocks, and those of wide passes

  WEIR_HOST_DEVICE std::uint32_t count() const {
    if (available == nullptr) return most;
    const std::uint32_t all = *available;
    const std::uint32_t left = all > first ? all - first : 0;
    return left < most ? left : most;
  }
};

}  // namespace weir
