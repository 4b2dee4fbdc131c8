// Reports the errors of vorticity and divergence, for people and for programs.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "compressor/derived/vector_error.h"

namespace weir {

/// Returns {"vorticity": {"rms", "source_rms", "relative_rms", "max_abs"}, "divergence": {...}, "voxels", "left_out"}.
nlohmann::ordered_json vector_json(const VectorErrors& errors);

/// Returns two lines for people. `units`: of the components' values, may be empty.
std::string vector_text(const VectorErrors& errors, const std::string& units);

}  // namespace weir
