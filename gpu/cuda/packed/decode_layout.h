// Shared memory of a group of threads that decodes packed blocks: where it holds what, and the magnitudes in it. For
// host and device.
#pragma once

#include <cstdint>

#include "format/base/host_device.h"
#include "format/packed/block_context.h"
#include "format/packed/coefficient_decoder.h"

namespace weir {

inline constexpr unsigned kWarp = 32;

namespace decode_detail {

// The places of the first two shells, which hold nearly all that is large, have 16 bits, the others 8.
inline constexpr unsigned kWidePlaces = 64;
inline constexpr unsigned kNarrowPlaces = 512 - kWidePlaces;
inline constexpr std::uint32_t kMostWide = 32767;
inline constexpr std::uint32_t kMostNarrow = 127;
inline constexpr unsigned kSlotShift = 6;  // of the table of first symbols
inline constexpr unsigned kSlots = 1U << (kFrequencyBits - kSlotShift);
inline constexpr unsigned kContexts = kPackedLevels * kPackedBands;
// Lines of eight, each followed by a gap: no two lanes meet in a bank.
inline constexpr unsigned kStageFloats = 576;

// What the second step must know of a block.
struct BlockTask {
  float step = 0;   // 0: the block has one value
  float value = 0;  // that, or the mean
  std::uint16_t limit = 0;
  std::uint16_t skip = 1;  // left to one thread, or beyond the list
};

}  // namespace decode_detail

/// Where a group's shared memory holds what.
struct DecodeLayout {
  unsigned stride = 0;  ///< of two magnitudes of a block
  unsigned symbols = 0, starts = 0, levels = 0, wide = 0, narrow = 0, tasks = 0, stage = 0;
  unsigned bytes = 0;
};

/// For a group of that many threads, a multiple of kWarp.
WEIR_HOST_DEVICE constexpr DecodeLayout decode_layout(unsigned threads) {
  using namespace decode_detail;
  DecodeLayout at;
  at.stride = threads + 4;
  at.starts = at.symbols + kContexts * kPackedSymbols * 4;
  at.levels = at.starts + kContexts * kSlots;
  at.wide = at.levels + (kLevelSums + 15) / 16 * 16;
  at.narrow = at.wide + kWidePlaces * at.stride * 2;
  at.tasks = at.narrow + kNarrowPlaces * at.stride;
  at.stage = at.tasks + threads * static_cast<unsigned>(sizeof(BlockTask));
  at.bytes = at.stage + threads / kWarp * kStageFloats * 4;
  return at;
}

namespace decode_detail {

// A block's magnitudes by place, later with their signs.
class Magnitudes {
 public:
  WEIR_HOST_DEVICE Magnitudes(unsigned char* shared, const DecodeLayout& layout, unsigned block)
      : wide_(reinterpret_cast<std::int16_t*>(shared + layout.wide) + block),
        narrow_(reinterpret_cast<std::int8_t*>(shared + layout.narrow) + block),
        stride_(layout.stride) {}

  WEIR_HOST_DEVICE std::int32_t at(unsigned place) const {
    return place < kWidePlaces ? wide_[place * stride_] : narrow_[(place - kWidePlaces) * stride_];
  }
  /// False where there is no room for it.
  WEIR_HOST_DEVICE bool set(unsigned place, std::uint32_t magnitude) {
    if (place < kWidePlaces) {
      wide_[place * stride_] = static_cast<std::int16_t>(magnitude);
      return magnitude <= kMostWide;
    }
    narrow_[(place - kWidePlaces) * stride_] = static_cast<std::int8_t>(magnitude);
    return magnitude <= kMostNarrow;
  }
  WEIR_HOST_DEVICE void negate(unsigned place) {
    if (place < kWidePlaces) {
      wide_[place * stride_] = static_cast<std::int16_t>(-wide_[place * stride_]);
    } else {
      std::int8_t& narrow = narrow_[(place - kWidePlaces) * stride_];
      narrow = static_cast<std::int8_t>(-narrow);
    }
  }

 private:
  std::int16_t* wide_;
  std::int8_t* narrow_;
  unsigned stride_;
};

}  // namespace decode_detail

}  // namespace weir
