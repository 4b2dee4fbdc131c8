// The errors of what is derived from a volume, for people and for programs.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "compressor/derived/derived_error.h"

namespace weir {

/// {"quantiles": {"0.5": E, ...}, "octaves": {"zeros", "first", "counts"}, "gradient": {...}, "ssim", ...}.
nlohmann::ordered_json derived_json(const DerivedErrors& errors);

/// Three lines. `range`: of the source, largest value less smallest; `units`: of its values, perhaps empty.
std::string derived_text(const DerivedErrors& errors, double range, const std::string& units);

}  // namespace weir
