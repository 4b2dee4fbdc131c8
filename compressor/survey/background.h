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
  /// How the value was found. "user": given by the user; "source": the file of a level set names it; "mode": the most
  /// frequent value of the fullest bin, counted; "sampled-mode": the same from one voxel per leaf; "bin": the middle of
  /// the fullest bin, if no value occurs twice; "paper": paper_background(); "none": there is no finite value.
  std::string method;
  double share = 0;  ///< share of the finite voxels that have this value; for "sampled-mode" the share of the samples,
                     ///< for "bin" and "paper" the share of the finite voxels that lie in the bin
};

/// Volumes of up to this many voxels are read once more and counted exactly, if their type has too many values to
/// count in the survey.
inline constexpr std::int64_t kExactModeVoxels = std::int64_t{1} << 21;
/// In larger volumes, at most this many leaves, evenly spaced, take part with one sampled voxel each.
inline constexpr std::int64_t kModeSamples = std::int64_t{1} << 21;

/// Returns the background that the source names, otherwise the most frequent value. Among equal counts the lowest bin
/// and the lowest value win. -0.0 counts as 0.0.
Background find_background(const Survey& survey, const RowStore& rows, VolumeSource& source, const BlockPlan& plan,
                           const StreamOptions& options);

/// Returns the background of the paper (Zellmann et al., EGPGV 2025): the left edge of the fullest of 1024 bins,
/// lo + i/1023 (hi - lo). It is computed in float as the paper's code does, but in double if hi - lo overflows. Reads
/// the volume once more unless the survey counted every value.
Background paper_background(const Survey& survey, VolumeSource& source, const BlockPlan& plan,
                            const StreamOptions& options, Team& team = no_team());

}  // namespace weir
