// The report of `weir inspect` about how the blocks of a packed grid are coded.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "format/nanovdb/packed_data.h"
#include "tools/verify/packed_census.h"

namespace weir {

/// Returns lines for people, including the last newline.
std::string packed_text(const PackedData& packed, const PackedCensus& census);

nlohmann::ordered_json packed_json(const PackedData& packed, const PackedCensus& census);

}  // namespace weir
