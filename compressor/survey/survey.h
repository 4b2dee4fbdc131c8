// The survey pass: one streaming read of the volume that leaves a row per leaf
// in the spill file, the finite range, the histogram and the source's digest.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "compressor/survey/leaf_faces.h"
#include "compressor/survey/leaf_store.h"
#include "compressor/survey/pauses.h"
#include "compressor/survey/range_histogram.h"
#include "compressor/survey/row_store.h"
#include "compressor/survey/survey_tally.h"
#include "ingest/plan/block_plan.h"
#include "ingest/plan/block_stream.h"
#include "ingest/source/volume_source.h"

namespace weir {

struct Survey {
  float min = 0;  ///< of the finite values; 0 where there is none
  float max = 0;
  std::uint64_t finite = 0;      ///< voxels
  std::uint64_t missing = 0;     ///< voxels the source declares to hold no data
  std::uint64_t non_finite = 0;  ///< voxels, the missing ones aside
  Index3 first_non_finite;       ///< first in x-fastest order, index space; valid where non_finite > 0
  float first_non_finite_value = 0;
  RangeHistogram histogram;  ///< of the finite values
  /// Counts of every value of an 8- or 16-bit source, from `value_offset` on; empty for other types.
  std::vector<std::uint64_t> value_counts;
  int value_offset = 0;
  ConversionLoss loss;

  std::uint64_t voxels() const { return finite + missing + non_finite; }
};

/// Reads the volume once by `plan` and fills `rows`. The result does not depend on the plan or the
/// number of threads, nor on the way of reading. `widths` asks for what each
/// width of a quantised leaf would cost (LeafRow::quantised and exact_bits), which takes as long again. `faces`, where
/// given, gets the outer layers of each leaf (leaf_reach.h). `state`, where given, says what of all this is done
/// already, by any plan, is brought up to date when `pauses` ask for it, and in the end is of the whole volume. Each
/// rank of the rows' team reads its own part.
Survey survey_volume(VolumeSource& source, const BlockPlan& plan, RowStore& rows, const StreamOptions& options,
                     Reading reading = Reading::ahead, bool widths = false, LeafStore<LeafFaces>* faces = nullptr,
                     SurveyState* state = nullptr, const Pauses& pauses = {});

/// xxh3-128 over the rows' digests in leaf order, 32 hex digits: the sidecar's source.digest.
std::string source_digest(const RowStore& rows);

}  // namespace weir
