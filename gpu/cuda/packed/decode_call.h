// The arguments of a call that decodes packed blocks, and the data that its steps pass on. For host and device.
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

// Bins of blocks, in order: coded blocks of the narrow pass, the longest first; blocks that have one value or are not
// coded; blocks of the wide pass, whose values do not fit 16 bits.
inline constexpr unsigned kEnds = 512 / kEndUnit;
inline constexpr unsigned kFillBin = 2 * kEnds + 2;
inline constexpr unsigned kWideBins = kFillBin + 1;
inline constexpr unsigned kBins = kWideBins + kEnds + 1;

enum class TaskKind : std::uint8_t { fill, raw, transform, lattice };

// Number of places whose nonzero magnitudes are counted together.
inline constexpr unsigned kRun = 8;

// What the first step finds out about a block.
struct alignas(16) TaskHead {
  const std::byte* bytes = nullptr;  // raw values; later the bytes with the first `early` signs
  float value = 0;                   // the only value; later a transform's mean or a lattice's minimum
  TaskKind kind = TaskKind::fill;
  std::uint8_t bin = 0;
  bool wide = false;  // the block belongs to the wide pass
};

// What the steps that decode magnitudes and make values know of a block.
struct BlockTask : TaskHead {
  std::uint32_t first_sign = 0;  // first bit of the signs in `bytes`
  std::uint32_t early = 0;
  std::uint32_t payload = 0;  // the remaining signs
  float step = 0;             // of a transform; or a lattice's quantum
  std::uint32_t base = 0;     // first code of a lattice
  std::uint16_t limit = 0;    // places from here on are zero
  std::uint16_t half = 0;     // number of nonzero magnitudes before place 256
  std::uint8_t predictor = 0;
  bool ordered = false;
  std::uint8_t before[512 / kRun] = {};  // nonzero magnitudes before each run, counted from place 0 or 256
};

// Counters on the device, cleared before a call.
struct CallCounts {
  std::uint32_t overflown = 0;  // blocks that the narrow pass has left to the wide one
  std::uint32_t coded = 0;      // coded blocks of the narrow pass, at the front of the order
  std::uint32_t narrow = 0;     // those, and the blocks that are filled
  std::uint32_t bin[kBins] = {};
  std::uint32_t taken[kBins] = {};  // blocks of each bin that have their position already
};

}  // namespace decode_detail

/// Arguments of a call that decodes.
struct DecodeCall {
  PackedView view;
  const unsigned char* tables = nullptr;  ///< SharedTables
  const BlockId* blocks = nullptr;
  std::uint32_t most = 0;
  const std::uint32_t* available = nullptr;  ///< if not null, at most *available - `first` blocks are decoded
  std::uint32_t first = 0;
  float* values = nullptr;                    ///< 512 per block, at a multiple of 16 bytes
  decode_detail::BlockTask* tasks = nullptr;  ///< one per block
  std::uint32_t* order = nullptr;             ///< blocks by bin
  std::uint32_t* overflown = nullptr;         ///< blocks that the narrow pass has left to the wide one
  decode_detail::CallCounts* counts = nullptr;
  std::uint32_t* totals = nullptr;  ///< numbers of damaged blocks and of blocks of wide passes

  WEIR_HOST_DEVICE std::uint32_t count() const {
    if (available == nullptr) return most;
    const std::uint32_t all = *available;
    const std::uint32_t left = all > first ? all - first : 0;
    return left < most ? left : most;
  }
};

}  // namespace weir
