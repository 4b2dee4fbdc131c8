// The order in which the coefficients of a packed block are coded, and the neighbours that give each one its context
// (FORMAT.md, "Coded values"). Computed at compile time; a kernel gets a copy.
#pragma once

#include <cstdint>

#include "format/packed/block_context.h"

namespace weir {

struct BlockScan {
  std::uint16_t index[512] = {};  ///< index by place: i << 6 | j << 3 | k
  std::uint16_t place[512] = {};  ///< place by index
  std::uint8_t band[512] = {};    ///< band by place
  /// By place: indices of its neighbours (512: no neighbour), and the weight that their sum is multiplied by.
  std::uint16_t neighbour[512][3] = {};
  std::uint8_t weight[512] = {};
  std::uint8_t level[kLevelSums] = {};  ///< level by the weighted sum of the neighbours
};

namespace packed_detail {

constexpr unsigned axis_sum(unsigned index) { return (index >> 6U) + (index >> 3U & 7U) + (index & 7U); }
constexpr unsigned shell(unsigned index) {
  unsigned most = index >> 6U;
  most = most > (index >> 3U & 7U) ? most : index >> 3U & 7U;
  most = most > (index & 7U) ? most : index & 7U;
  return most < 2 ? 0 : most < 4 ? 1 : 2;
}

constexpr BlockScan make_scan() {
  BlockScan scan;
  unsigned place = 0;
  for (unsigned s = 0; s < 3; ++s) {
    for (unsigned sum = 0; sum < 22; ++sum) {
      for (unsigned index = 0; index < 512; ++index) {
        if (shell(index) != s || axis_sum(index) != sum) continue;
        scan.index[place] = static_cast<std::uint16_t>(index);
        scan.place[index] = static_cast<std::uint16_t>(place);
        scan.band[place] = sum < 2 ? 0 : sum < 6 ? 1 : sum < 10 ? 2 : 3;
        ++place;
      }
    }
  }
  for (unsigned p = 0; p < 512; ++p) {
    const unsigned index = scan.index[p];
    unsigned count = 0;
    for (unsigned n = 0; n < 3; ++n) scan.neighbour[p][n] = 512;
    if (p >= 1 && p <= 3) {
      for (unsigned q = 1; q < p; ++q) scan.neighbour[p][count++] = scan.index[q];
    } else if (p > 3) {
      for (unsigned step = 64; step > 0; step /= 8) {
        const unsigned axis = step == 64 ? index >> 6U : step == 8 ? index >> 3U & 7U : index & 7U;
        if (axis > 0 && index != step) scan.neighbour[p][count++] = static_cast<std::uint16_t>(index - step);
      }
    }
    scan.weight[p] = count == 3 ? 2 : count == 2 ? 3 : 6;
  }
  make_levels(scan.level);
  return scan;
}

}  // namespace packed_detail

inline constexpr BlockScan kBlockScan = packed_detail::make_scan();

}  // namespace weir
