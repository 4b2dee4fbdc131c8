#include "tools/options/series_checks.h"

#include <filesystem>
#include <string_view>
#include <vector>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/file_id.h"
#include "format/io/real_path.h"
#include "format/output/output_place.h"
#include "ingest/source/extent.h"
#include "ingest/source_registry.h"
#include "tools/report/finished_output.h"

namespace weir {

void check_outputs(std::span<const SeriesStep> steps, std::span<const std::string> outputs, bool may_exist) {
  std::error_code ignored;
  std::vector<FileId> inputs;
  for (const SeriesStep& step : steps) {
    if (const auto id = file_id(step.path)) inputs.push_back(*id);
  }
  for (std::size_t i = 0; i < steps.size(); ++i) {
    check_output(steps[i].path, outputs[i]);
    require_not_input(inputs, outputs[i]);
    if (steps.size() > 1 && !may_exist && std::filesystem::exists(outputs[i], ignored)) {
      throw existing_output(outputs[i]);
    }
  }
}

void SeriesExtents::check(const SeriesStep& step, const SourceInfo& info) {
  if (!by_extent_) return;
  const std::string place = info.dataset.empty() ? info.path : cat(info.path, ": ", info.dataset);
  const First& first = first_.emplace(step.series, First{place, info.extent}).first->second;
  if (info.extent == first.extent) return;
  throw Error(ErrorKind::input,
              compose(place, ": extent ", extent_text(info.extent), " differs from ", extent_text(first.extent), " of ",
                      first.place, ", so that a rate gives files of two sizes; give ", option("size")));
}

void SeriesExtents::check_all(std::span<const SeriesStep> steps,
                              const std::function<std::unique_ptr<VolumeSource>(const SeriesStep&)>& open) {
  if (!by_extent_ || steps.size() < 2) return;
  for (const SeriesStep& step : steps) {
    // Sources of other formats may have to be unpacked when they are opened, so they are checked in their turn.
    const std::string_view format = is_there(step.path) ? format_of(step.path).name : "";
    if (format == "raw" || format == "hdf5") check(step, open(step)->info());
  }
}

}  // namespace weir
