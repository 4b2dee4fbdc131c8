// The entropy coder's tables in the shared memory of a group of threads. For host and device.
#pragma once

#include <cstdint>

#include "format/base/host_device.h"
#include "format/packed/block_scan.h"
#include "format/packed/coefficient_decoder.h"
#include "gpu/cuda/packed/decode_layout.h"

namespace weir {

/// The order of the scan as a warp looks it up, all its threads the same place.
struct ScanPlaces {
  std::uint16_t neighbour[512][3] = {};  ///< places; 0, whose magnitude is zero, where there is none
  std::uint8_t weight[512] = {};
  std::uint8_t band[512] = {};
};

constexpr ScanPlaces make_scan_places() {
  ScanPlaces places;
  for (unsigned place = 0; place < 512; ++place) {
    for (unsigned n = 0; n < 3; ++n) {
      const unsigned index = kBlockScan.neighbour[place][n];
      places.neighbour[place][n] = index < 512 ? kBlockScan.place[index] : std::uint16_t{0};
    }
    places.weight[place] = kBlockScan.weight[place];
    places.band[place] = kBlockScan.band[place];
  }
  return places;
}

namespace decode_detail {

// The tables of the entropy coder in shared memory.
class SharedTables {
 public:
  WEIR_HOST_DEVICE SharedTables(unsigned char* shared, const DecodeLayout& layout)
      : symbols_(reinterpret_cast<std::uint32_t*>(shared + layout.symbols)),
        starts_(shared + layout.starts),
        levels_(shared + layout.levels) {}

  template <class Thread>
  WEIR_HOST_DEVICE void fill(const Thread& thread, const BlockScan& scan, const std::uint16_t* tables) {
    for (unsigned i = thread.index(); i < kContexts * kPackedSymbols; i += thread.count()) {
      const std::uint32_t high = i % kPackedSymbols + 1 < kPackedSymbols ? tables[i + 1] : 1U << kFrequencyBits;
      symbols_[i] = tables[i] | high << 16U;
    }
    for (unsigned i = thread.index(); i < kContexts * kSlots; i += thread.count()) {
      const std::uint16_t* table = tables + i / kSlots * kPackedSymbols;
      unsigned found = 0;
      for (unsigned j = 1; j < kPackedSymbols; ++j) found += table[j] <= (i % kSlots) << kSlotShift ? 1U : 0U;
      starts_[i] = static_cast<std::uint8_t>(found);
    }
    for (unsigned i = thread.index(); i < kLevelSums; i += thread.count()) levels_[i] = scan.level[i];
  }

  WEIR_HOST_DEVICE unsigned level(std::uint32_t t) const { return t < kLevelSums ? levels_[t] : kPackedLevels - 1; }

  WEIR_HOST_DEVICE unsigned symbol(std::uint32_t& x, unsigned context, StreamWords& words) const {
    const std::uint32_t slot = x & ((1U << kFrequencyBits) - 1U);
    unsigned found = starts_[context * kSlots + (slot >> kSlotShift)];
    std::uint32_t bounds = symbols_[context * kPackedSymbols + found];
    while (slot >= bounds >> 16U) bounds = symbols_[context * kPackedSymbols + ++found];
    const std::uint32_t low = bounds & 0xFFFFU;
    x = ((bounds >> 16U) - low) * (x >> kFrequencyBits) + slot - low;
    words.renormalise(x);
    return found;
  }

 private:
  std::uint32_t* symbols_;
  unsigned char* starts_;
  unsigned char* levels_;
};

}  // namespace decode_detail

}  // namespace weir
