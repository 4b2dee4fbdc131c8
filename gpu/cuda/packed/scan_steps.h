// The scan for a thread that keeps only the magnitudes that later places still need, in a window of slots. Made at
// compile time; each kernel gets a copy.
#pragma once

#include <cstdint>

#include "format/packed/block_constants.h"
#include "format/packed/block_scan.h"

namespace weir {

/// Buckets of a context's symbols, by the upper bits of a state's slot.
inline constexpr unsigned kSymbolBuckets = 256;

/// The step of one place. Slots are counted in units of two bytes.
struct alignas(8) ScanStep {
  std::uint32_t slots = 0;  ///< one byte each: slots of three neighbours (0: no neighbour), then of the place itself
  std::uint32_t rule = 0;   ///< factor of the neighbours' sum | kSymbolBuckets * first context << 16
};

struct ScanSteps {
  ScanStep of[512] = {};
  unsigned slots = 0;  ///< number of the window's slots; slot 0 holds zero
};

namespace decode_detail {

constexpr ScanSteps make_scan_steps() {
  ScanSteps steps;
  unsigned last_use[512] = {};
  for (unsigned place = 1; place < 512; ++place) {
    for (const unsigned index : kBlockScan.neighbour[place]) {
      if (index < 512) last_use[kBlockScan.place[index]] = place;
    }
  }
  unsigned slot_of[512] = {};
  unsigned free_from[512] = {};  // by slot: the first place that may overwrite it
  for (unsigned place = 1; place < 512; ++place) {
    ScanStep& step = steps.of[place];
    for (unsigned n = 0; n < 3; ++n) {
      const unsigned index = kBlockScan.neighbour[place][n];
      if (index < 512) step.slots |= 2 * slot_of[kBlockScan.place[index]] << 8 * n;
    }
    unsigned slot = 1;
    while (free_from[slot] > place) ++slot;
    slot_of[place] = slot;
    free_from[slot] = last_use[place];
    step.slots |= 2 * slot << 24U;
    step.rule = kBlockScan.weight[place] | kBlockScan.band[place] * kPackedLevels * kSymbolBuckets << 16U;
    steps.slots = steps.slots > slot + 1 ? steps.slots : slot + 1;
  }
  return steps;
}

}  // namespace decode_detail

inline constexpr ScanSteps kScanSteps = decode_detail::make_scan_steps();

}  // namespace weir
