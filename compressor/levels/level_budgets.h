// Whether the size that is asked for suits all levels of a file, before the first is converted.
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

/// Where step `at` of `steps` is the first of the levels of a file (Levels::separate), each of which `open` opens:
/// throws Error(budget) where a size or a rate gives one of them less than its smallest tree, with a budget that suits
/// all of them. `outputs` are those of `steps`. Reads no values, whose NaN may make a tree larger.
void check_level_budgets(std::span<const SeriesStep> steps, std::span<const std::string> outputs, std::size_t at,
                         const ConversionOptions& options,
                         const std::function<std::unique_ptr<VolumeSource>(const SeriesStep&)>& open);

}  // namespace weir
