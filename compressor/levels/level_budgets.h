// Checks whether the asked size suits all levels of a file, before the first level is converted.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "compressor/conversion_options.h"
#include "ingest/series.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Checks the levels of a file (Levels::separate) if step `at` of `steps` is the file's first level. `open` opens a
/// step; `outputs` are the outputs of `steps`. Throws Error(budget) that names a budget that suits all levels, if a
/// size or a rate gives a level less than its smallest tree. Reads no values, so it does not know of NaN that make a
/// tree larger.
void check_level_budgets(std::span<const SeriesStep> steps, std::span<const std::string> outputs, std::size_t at,
                         const ConversionOptions& options,
                         const std::function<std::unique_ptr<VolumeSource>(const SeriesStep&)>& open);

}  // namespace weir
