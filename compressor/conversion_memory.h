// What a conversion takes of memory by its options, besides the blocks that it reads.
#pragma once

#include <cstdint>

#include "compressor/conversion_options.h"
#include "format/base/index.h"

namespace weir {

/// Of the rows of a region that selection holds (memory_plan.h).
std::uint64_t region_bytes(const ConversionOptions& options);

/// Most bytes that the records of all leaves of a volume over `domain` take at a time: rows, and what selection and
/// encoding add.
std::uint64_t record_bytes(const ConversionOptions& options, const Box& domain);

}  // namespace weir
