// The survey pass: one streaming read of the volume. The pass writes one row per leaf to the spill file, and finds the
// range of the finite values, the histogram and the source's digest.
#pragma once

#include <span>
#include <string>

#include "compressor/packed/ladder_builder.h"
#include "compressor/survey/block_survey.h"
#include "compressor/survey/leaf_faces.h"
#include "compressor/survey/leaf_store.h"
#include "compressor/survey/pauses.h"
#include "compressor/survey/row_store.h"
#include "compressor/survey/survey_figures.h"
#include "compressor/survey/survey_tally.h"
#include "ingest/plan/block_plan.h"
#include "ingest/plan/block_stream.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// How a survey reads the volume, and what the survey finds besides the rows.
struct SurveyTask {
  Reading reading = Reading::ahead;
  /// Whether the survey also finds the cost of each width of a quantised leaf (LeafRow::quantised and exact_bits).
  /// This doubles the survey's time.
  bool widths = false;
  LeafStore<LeafFaces>* faces = nullptr;  ///< if not null, receives the outer layers of each leaf (leaf_reach.h)
  /// If not null: on entry, the leaves that an earlier survey finished, by any plan. Updated when `pauses` ask for it.
  /// At the end it covers the whole volume. It stays unchanged if a device surveys: a journal keeps no such survey.
  SurveyState* state = nullptr;
  Pauses pauses{};
  std::optional<LadderAim> ladders{};  ///< if given, the survey fills the ladders of `rows`
};

/// Reads the volume once by `plan` and fills `rows`. The result does not depend on the plan, the number of threads or
/// the way of reading. Each rank of the rows' team reads its own part.
Survey survey_volume(VolumeSource& source, const BlockPlan& plan, RowStore& rows, const StreamOptions& options,
                     const SurveyTask& task = {});

/// Streams the leaves of `leaf_boxes`, none larger than a block of `plan`, into `survey`.
void survey_boxes(VolumeSource& source, const BlockPlan& plan, std::span<const Box> leaf_boxes,
                  const StreamOptions& options, Reading reading, BlockSurvey& survey);

/// Returns the xxh3-128 over the rows' digests in leaf order as 32 hex digits: the sidecar's source.digest.
std::string source_digest(const RowStore& rows);

}  // namespace weir
