// Reads the blind data records of a grid: the extent of them all, the content of weir's macrocells, the place of its
// packed data.
#pragma once

#include <cstdint>

#include "format/base/index.h"
#include "format/nanovdb/macrocells.h"
#include "format/nanovdb/nvdb_bytes.h"

namespace weir {

struct NvdbBlindData {
  MacrocellView macrocells;
  std::uint64_t packed = 0;        ///< offset of the packed data from the grid's start
  std::uint64_t packed_bytes = 0;  ///< 0 if there is none
  /// End of the last byte of records and data, from the grid's start. It is the grid's size if a record has elements of
  /// unknown size, and `tree_end` if there are no records.
  std::uint64_t end = 0;
};

/// Checks the records of `grid`, which begin at or behind `tree_end`, and finds the macrocells over `bbox`. Macrocells
/// that are not aligned to 4 bytes in memory (a foreign tool moved the grid) count as absent. Does not read the content
/// of packed data. Throws Error(input) that names offset and value.
NvdbBlindData read_nvdb_blind_data(const NvdbBytes& grid, std::uint64_t tree_end, const Box& bbox);

}  // namespace weir
