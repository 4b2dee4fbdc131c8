// The blind data records of a grid: bounds of all, content of weir's macrocells, place of its packed data.
#pragma once

#include <cstdint>

#include "format/base/index.h"
#include "format/nanovdb/macrocells.h"
#include "format/nanovdb/nvdb_bytes.h"

namespace weir {

struct NvdbBlindData {
  MacrocellView macrocells;
  std::uint64_t packed = 0;        ///< where the packed data begins, from the grid's start
  std::uint64_t packed_bytes = 0;  ///< 0 where there is none
  /// Past the last byte of records and data, from the grid's start; the grid's size where a record
  /// has elements of unknown size; `tree_end` where there are no records.
  std::uint64_t end = 0;
};

/// Checks the records of `grid`, which begin at or behind `tree_end`, and finds the macrocells over
/// `bbox`. Macrocells that are not aligned to 4 bytes in memory (a foreign tool moved the grid) count
/// as absent; the content of packed data is not looked at. Throws Error(input) naming offset and value.
NvdbBlindData read_nvdb_blind_data(const NvdbBytes& grid, std::uint64_t tree_end, const Box& bbox);

}  // namespace weir
