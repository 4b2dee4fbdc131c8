// The entropy coder's tables in the shared memory of a group of threads, and a stream's words. For host and device.
#pragma once

#include <cstddef>
#include <cstdint>

#include "format/base/host_device.h"
#include "format/packed/block_scan.h"
#include "gpu/cuda/packed/decode_layout.h"
#include "gpu/cuda/packed/packed_view.h"

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

// The words of a block's coders, read from the stream's end; the next one is loaded ahead.
class Words {
 public:
  WEIR_HOST_DEVICE void start(const std::byte* front, const std::byte* at) {
    front_ = front;
    at_ = at;
    load();
  }
  WEIR_HOST_DEVICE void renormalise(std::uint32_t& x) {
    if (x >= kLeastState) return;
    if (at_ - front_ < 2) {
      whole_ = false;
      x |= kLeastState;
      return;
    }
    x = x << 16U | next_;
    at_ -= 2;
    load();
  }
  WEIR_HOST_DEVICE const std::byte* at() const { return at_; }
  WEIR_HOST_DEVICE bool whole() const { return whole_; }

 private:
  WEIR_HOST_DEVICE void load() { next_ = at_ - front_ >= 2 ? packed_detail::load_u16(at_ - 2) : 0; }

  const std::byte* front_ = nullptr;
  const std::byte* at_ = nullptr;
  std::uint32_t next_ = 0;
  bool whole_ = true;
};

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

  WEIR_HOST_DEVICE unsigned symbol(std::uint32_t& x, unsigned context, Words& words) const {
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

WEIR_HOST_DEVICE inline std::uint32_t bypass(std::uint32_t& x, unsigned bits, Words& words) {
  std::uint32_t value = 0;
  for (unsigned got = 0; got < bits;) {
    const unsigned take = bits - got < 16 ? bits - got : 16;
    value |= (x & ((1U << take) - 1U)) << got;
    x >>= take;
    words.renormalise(x);
    got += take;
  }
  return value;
}

}  // namespace decode_detail

}  // namespace weir
