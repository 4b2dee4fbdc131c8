// What coded values take together, without the constant parts. Value by value as RowCosts::of() of row_costs.h. For
// host and device.
#pragma once

#include <cstdint>

#include "format/base/host_device.h"
#include "gpu/cuda/encode/encoder_tables.h"

namespace weir::encode_detail {

struct SymbolSums {
  std::uint32_t symbols = 0;
  std::uint32_t raw = 0;
  std::uint32_t nonzero = 0;
};

// Returns the bits of the part of a magnitude that remains above its extra bits. This part `high` is kEscape or more.
WEIR_HOST_DEVICE inline std::uint32_t bits_of_escape(std::uint32_t high) {
  return 5 + 31U - static_cast<unsigned>(__builtin_clz(high - (kEscape - 1)));
}

// Adds value `m`, for a weighted sum `t` of its neighbours, in a context whose costs begin at `first`.
WEIR_HOST_DEVICE inline void add_value(const CostTables& tables, std::uint32_t first, std::uint32_t t, std::uint32_t m,
                                       SymbolSums& sums) {
  if ((t | m) == 0) {
    sums.symbols += tables.cost[first];
    return;
  }
  const unsigned extra = extra_bits(t);
  const std::uint32_t high = m >> extra;
  const std::uint32_t symbol = high < kEscape ? high : kEscape;
  sums.symbols += tables.cost[first + kPackedSymbols * tables.level_of(t) + symbol];
  sums.raw += extra + (high >= kEscape ? bits_of_escape(high) : 0);
  sums.nonzero += m != 0 ? 1U : 0U;
}

// Adds the values at places 1 to 3, whose contexts depend on each other. at(index) returns a magnitude.
// first_of(known) returns where the costs of a place's contexts begin; `known` is the table's entry for the place.
template <class At, class FirstOf>
WEIR_HOST_DEVICE inline void add_first_places(const CostTables& tables, const At& at, const FirstOf& first_of,
                                              SymbolSums& sums) {
  std::uint32_t before = 0;
  WEIR_UNROLL
  for (unsigned place = 1; place < 4; ++place) {
    const unsigned index = place == 1 ? 1 : place == 2 ? 8 : 64;
    const std::uint32_t m = at(index);
    const std::uint32_t known = tables.place[index];
    add_value(tables, first_of(known), (known >> 9U & 7U) * before, m, sums);
    before += m;
  }
}

}  // namespace weir::encode_detail
