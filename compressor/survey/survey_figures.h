// What the survey pass finds about a volume as a whole.
#pragma once

#include <cstdint>
#include <vector>

#include "compressor/survey/range_histogram.h"
#include "format/base/index.h"
#include "ingest/source/volume_source.h"

namespace weir {

struct Survey {
  float min = 0;  ///< smallest finite value; 0 if there is none
  float max = 0;
  std::uint64_t finite = 0;      ///< voxels
  std::uint64_t missing = 0;     ///< voxels the source declares to hold no data
  std::uint64_t non_finite = 0;  ///< voxels, without the missing ones
  Index3 first_non_finite;       ///< first in x-fastest order, index space; valid if non_finite > 0
  float first_non_finite_value = 0;
  Index3 first_missing;      ///< first missing voxel in x-fastest order, index space; valid if missing > 0
  RangeHistogram histogram;  ///< of the finite values
  /// Counts of every value of an 8- or 16-bit source, from `value_offset` on; empty for other types.
  std::vector<std::uint64_t> value_counts;
  int value_offset = 0;
  ConversionLoss loss;

  std::uint64_t voxels() const { return finite + missing + non_finite; }
};

}  // namespace weir
