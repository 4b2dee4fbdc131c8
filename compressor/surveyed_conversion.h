// All of a conversion that comes after the survey: background, selection, the
// encode pass and the finish, for whoever surveyed the volume.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>

#include "compressor/conversion_control.h"
#include "compressor/conversion_options.h"
#include "compressor/packed/ladder_builder.h"
#include "compressor/packed/ladder_state.h"
#include "compressor/plan/reading_plan.h"
#include "compressor/resume/journal.h"
#include "compressor/resume/work_directory.h"
#include "compressor/survey/leaf_faces.h"
#include "compressor/survey/leaf_store.h"
#include "compressor/survey/row_store.h"
#include "compressor/survey/survey.h"
#include "compressor/survey/visibility.h"
#include "format/output/output_files.h"
#include "format/sidecar/sidecar.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// What one conversion works with; all of it outlives its steps.
struct ConversionParts {
  VolumeSource& source;
  const ConversionOptions& options;
  const ConversionControl& control;
  OutputFiles& output;
  WorkDirectory& work;
  Journal* journal;                       ///< null: what is interrupted is lost
  const std::optional<Visibility>& seen;  ///< of options.scene
};

/// Of options.scene, for a volume over `domain`. Throws Error(usage) where the metric has no use for it, and as
/// Visibility does.
std::optional<Visibility> visibility_of(const ConversionOptions& options, const Box& domain);

/// Throws where a file that the source lies in is not as it was when it was opened (ingest/files/file_state.h), on all
/// ranks.
void check_source(const VolumeSource& source, Team& team);

/// Whether the survey is to look at the widths of quantised leaves (survey.h).
bool surveys_widths(const ConversionOptions& options);

/// What the survey is to look for in blocks that are packed; none where none is.
std::optional<LadderAim> surveyed_ladders(const ConversionOptions& options, const SourceInfo& source);

/// The files that a survey fills.
struct SurveyStores {
  RowStore rows;
  std::optional<LeafStore<LeafFaces>> faces;  ///< with a scene; given back once it is used
  LadderState ladders;                        ///< of packed blocks, as the survey built them
};

/// Empty ones of those leaves, in the files that `spill` gives for "rows", where a scene weighs "faces", and where
/// blocks are packed "ladders".
inline SurveyStores make_survey_stores(const std::function<std::shared_ptr<File>(const char* name)>& spill,
                                       const NodeLattice& leaves, const SelectionRoom& room, bool faces, bool ladders,
                                       Team& team = no_team()) {
  SurveyStores stores{RowStore(spill("rows"), leaves, room, team), {}, {}};
  if (faces) stores.faces.emplace(spill("faces"), leaves);
  if (ladders) stores.rows.set_ladders(std::make_unique<LeafStore<PackedLadder>>(spill("ladders"), leaves));
  return stores;
}

/// Writes the volume that `survey` and `stores` tell of, and its sidecar, which it returns. `started` is when the
/// survey was: for Sidecar::Timing.
Sidecar convert_surveyed(const ConversionParts& parts, const ReadingPlan& reading, const Survey& survey,
                         SurveyStores& stores, std::chrono::steady_clock::time_point started);

}  // namespace weir
