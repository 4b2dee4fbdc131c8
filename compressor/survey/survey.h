// The survey pass: one streaming read of the volume that leaves a row per leaf
// in the spill file, the finite range, the histogram and the source's digest.
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

/// What a survey finds besides the rows, and how.
struct SurveyTask {
  Reading reading = Reading::ahead;
  /// What each width of a quantised leaf would cost, too (LeafRow::quantised and exact_bits); takes as long again.
  bool widths = false;
  LeafStore<LeafFaces>* faces = nullptr;  ///< where given, gets the outer layers of each leaf (leaf_reach.h)
  /// Where given, what is done already, by any plan. Updated when `pauses` ask for it; of the whole volume in the end,
  /// but unchanged where a device surveys, of which a journal keeps nothing.
  SurveyState* state = nullptr;
  Pauses pauses{};
  std::optional<LadderAim> ladders{};  ///< where given, the rows' ladders are filled
};

/// Reads the volume once by `plan` and fills `rows`. The result does not depend on the plan or the number of threads,
/// nor on the way of reading. Each rank of the rows' team reads its own part.
Survey survey_volume(VolumeSource& source, const BlockPlan& plan, RowStore& rows, const StreamOptions& options,
                     const SurveyTask& task = {});

/// Streams the leaves of `leaf_boxes`, none larger than a block of `plan`, into `survey`.
void survey_boxes(VolumeSource& source, const BlockPlan& plan, std::span<const Box> leaf_boxes,
                  const StreamOptions& options, Reading reading, BlockSurvey& survey);

/// xxh3-128 over the rows' digests in leaf order, 32 hex digits: the sidecar's source.digest.
std::string source_digest(const RowStore& rows);

}  // namespace weir
