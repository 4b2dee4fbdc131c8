// The background: the value that most of the volume has.
#pragma once

#include <string>

#include "compressor/survey/row_store.h"
#include "compressor/survey/survey_figures.h"
#include "ingest/plan/block_plan.h"
#include "ingest/plan/block_stream.h"
#include "ingest/source/volume_source.h"

namespace weir {

struct Background {
  float value = 0;
  /// "user"; "source": what the file says of a level set; "mode": the most frequent value of the fullest bin, counted;
  /// "sampled-mode": the same from one voxel a leaf; "bin": the middle of the fullest bin, where no value occurs twice;
  /// "paper"; "none": there is no finite value.
  std::string method;
  double share = 0;  ///< of the finite voxels that have this value (of the samples for "sampled-mode", of the bin for
                     ///< "bin" and "paper")
};

/// Volumes up to this many voxels are read once more and counted exactly, if their type has too many
/// values to count in the survey.
inline constexpr std::int64_t kExactModeVoxels = std::int64_t{1} << 21;
/// Larger ones: at most this many leaves, evenly spaced, take part with one sampled voxel each.
inline constexpr std::int64_t kModeSamples = std::int64_t{1} << 21;

/// What the source says, if it says one. Else equal counts go to the lowest bin and the lowest value; -0.0 counts as
/// 0.0.
Background find_background(const Survey& survey, const RowStore& rows, VolumeSource& source, const BlockPlan& plan,
                           const StreamOptions& options);

/// The paper's: left edge of the fullest of its 1024 bins, lo + i/1023 (hi - lo), in float as its code
/// computes it (Zellmann et al., EGPGV 2025), in double where hi - lo overflows. One more pass over the volume unless
/// the survey counted every value.
Background paper_background(const Survey& survey, VolumeSource& source, const BlockPlan& plan,
                            const StreamOptions& options, Team& team = no_team());

}  // namespace weir
