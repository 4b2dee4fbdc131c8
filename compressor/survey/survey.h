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

/// Reads the volume once by `plan` and fills `rows`. The result does not depend on the plan or the
/// number of threads, nor on the way of reading. `widths` asks for what each
/// width of a quantised leaf would cost (LeafRow::quantised and exact_bits), which takes as long again. `ladders`,
/// where given, that the rows' ladders are filled. `faces`, where given, gets the outer layers of each leaf
/// (leaf_reach.h). `state`, where given, says what of all this is done already, by any plan; it is updated when
/// `pauses` ask for it, and covers the whole volume in the end. Each rank of the rows' team reads its own part.
Survey survey_volume(VolumeSource& source, const BlockPlan& plan, RowStore& rows, const StreamOptions& options,
                     Reading reading = Reading::ahead, bool widths = false, LeafStore<LeafFaces>* faces = nullptr,
                     SurveyState* state = nullptr, const Pauses& pauses = {},
                     const std::optional<LadderAim>& ladders = std::nullopt);

/// Streams the leaves of `leaf_boxes`, none larger than a block of `plan`, into `survey`.
void survey_boxes(VolumeSource& source, const BlockPlan& plan, std::span<const Box> leaf_boxes,
                  const StreamOptions& options, Reading reading, BlockSurvey& survey);

/// xxh3-128 over the rows' digests in leaf order, 32 hex digits: the sidecar's source.digest.
std::string source_digest(const RowStore& rows);

}  // namespace weir
