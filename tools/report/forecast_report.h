// What `weir convert --dry-run` says of a conversion that it did not make.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "compressor/conversion_options.h"
#include "compressor/forecast/forecast.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Lines for people, with the last newline.
std::string forecast_text(const Forecast& forecast, const SourceInfo& source, const ConversionOptions& options);

/// Bytes, seconds, dB; null where there is no such figure.
nlohmann::ordered_json forecast_json(const Forecast& forecast, const SourceInfo& source,
                                     const ConversionOptions& options);

}  // namespace weir
