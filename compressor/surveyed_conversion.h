// The part of a conversion that comes after the survey: background, selection, the encode pass and the finish. It
// serves every way in which the volume was surveyed.
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

/// The objects that one conversion works with. All of them outlive the conversion's steps.
struct ConversionParts {
  VolumeSource& source;
  const ConversionOptions& options;
  const ConversionControl& control;
  OutputFiles& output;
  WorkDirectory& work;
  Journal* journal;                       ///< null: an interrupted conversion is lost
  const std::optional<Visibility>& seen;  ///< visibility_of(options, ...)
};

/// Returns the visibility by options.scene for a volume over `domain`; nullopt without a scene. Throws Error(usage) if
/// the metric cannot use a scene, and as Visibility does.
std::optional<Visibility> visibility_of(const ConversionOptions& options, const Box& domain);

/// Throws on all ranks if a file of the source has changed since it was opened (ingest/files/file_state.h).
void check_source(const VolumeSource& source, Team& team);

/// Returns whether the survey looks at the widths of quantised leaves (survey.h).
bool surveys_widths(const ConversionOptions& options);

/// Returns what the survey looks for in packed blocks; nullopt if the encoding is not packed.
std::optional<LadderAim> surveyed_ladders(const ConversionOptions& options, const SourceInfo& source);

/// The files that a survey fills.
struct SurveyStores {
  RowStore rows;
  std::optional<LeafStore<LeafFaces>> faces;  ///< only with a scene; freed after use
  LadderState ladders;                        ///< how the survey built the ladders of packed blocks
};

/// Returns empty stores for `leaves`, in the files that `spill` gives for "rows", for "faces" if `faces` is set (a
/// scene weighs errors), and for "ladders" if `ladders` is set (blocks are packed).
inline SurveyStores make_survey_stores(const std::function<std::shared_ptr<File>(const char* name)>& spill,
                                       const NodeLattice& leaves, const SelectionRoom& room, bool faces, bool ladders,
                                       Team& team = no_team()) {
  SurveyStores stores{RowStore(spill("rows"), leaves, room, team), {}, {}};
  if (faces) stores.faces.emplace(spill("faces"), leaves);
  if (ladders) stores.rows.set_ladders(std::make_unique<LeafStore<PackedLadder>>(spill("ladders"), leaves));
  return stores;
}

/// Writes the volume that `survey` and `stores` describe, and its sidecar. Returns the sidecar. `started` is the time
/// from which Sidecar::Timing counts: the start of the conversion, or of a push's end().
Sidecar convert_surveyed(const ConversionParts& parts, const ReadingPlan& reading, const Survey& survey,
                         SurveyStores& stores, std::chrono::steady_clock::time_point started);

}  // namespace weir
