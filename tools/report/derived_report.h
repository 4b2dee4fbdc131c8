// Reports the errors of quantities that are derived from a volume, for people and for programs.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "compressor/derived/derived_error.h"

namespace weir {

/// Returns {"quantiles": {"0.5": E, ...}, "octaves": {"zeros", "first", "counts"}, "gradient": {...}, "ssim", ...}.
nlohmann::ordered_json derived_json(const DerivedErrors& errors);

/// Returns the report as lines for people. `range`: largest value of the source less its smallest; `units`: of its
/// values, may be empty.
std::string derived_text(const DerivedErrors& errors, double range, const std::string& units);

}  // namespace weir
