// What a survey has counted so far: everything it knows of the volume except the rows of the leaves. Tallies can be
// merged in any order.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "compressor/survey/range_histogram.h"
#include "compressor/survey/spill_sums.h"
#include "format/base/box_set.h"
#include "ingest/source/volume_source.h"

namespace weir {

struct SurveyTally {
  static constexpr std::int64_t kNowhere = std::numeric_limits<std::int64_t>::max();

  float min = std::numeric_limits<float>::infinity();  ///< smallest finite value
  float max = -std::numeric_limits<float>::infinity();
  std::uint64_t finite = 0;                  ///< voxels
  std::uint64_t missing = 0;                 ///< voxels the source declares to hold no data
  std::uint64_t non_finite = 0;              ///< voxels, without the missing ones
  std::int64_t first_non_finite = kNowhere;  ///< linear voxel index in the domain
  float first_non_finite_value = 0;
  std::int64_t first_missing = kNowhere;    ///< linear voxel index in the domain
  RangeHistogram histogram;                 ///< of the finite values that `value_counts` does not count
  std::vector<std::uint64_t> value_counts;  ///< of every value of an 8- or 16-bit type
  ConversionLoss loss;
  SpillSums sums;  ///< checksums of the spilled rows, faces and ladders; valid if the tally may go into a checkpoint

  /// Adds the counts of `other`, a tally of other leaves of the same volume.
  void merge(const SurveyTally& other);
};

/// The state of a survey between two blocks. Together with the rows (and faces) of `done` it suffices to continue.
struct SurveyState {
  SurveyTally tally;  ///< of the leaves in `done`
  BoxSet done;        ///< positions of the leaf lattice
};

}  // namespace weir
