// The report of `weir convert --dry-run` about a conversion that was not made.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "compressor/conversion_options.h"
#include "compressor/forecast/forecast.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Returns lines for people, including the last newline.
std::string forecast_text(const Forecast& forecast, const SourceInfo& source, const ConversionOptions& options);

/// Returns the figures in bytes, seconds and dB; null for a figure that is not known.
nlohmann::ordered_json forecast_json(const Forecast& forecast, const SourceInfo& source,
                                     const ConversionOptions& options);

}  // namespace weir
