// What a conversion takes of memory by its options, besides the blocks that it reads.
#pragma once

#include <cstddef>
#include <cstdint>

#include "compressor/conversion_options.h"
#include "compressor/plan/memory_plan.h"
#include "compressor/plan/reading_plan.h"
#include "format/base/index.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Of the rows of a region that selection holds (memory_plan.h).
std::uint64_t region_bytes(const ConversionOptions& options);

/// Most bytes that the records of all leaves of a volume over `domain` take at a time: rows, and what selection and
/// encoding add.
std::uint64_t record_bytes(const ConversionOptions& options, const Box& domain);

/// How a conversion divides its memory, and what it reads by that.
struct MemoryShares {
  MemoryPlan memory;
  ReadingPlan reading;
  std::uint64_t kept_bytes = 0;  ///< for values that the survey keeps for the encode pass (kept_leaves.h)
};

/// Of options.memory, of which `resident` bytes are in use. `may_hold`: records of leaves may stay in memory, since
/// nobody continues the conversion or takes part in it. They do where there is room, and where chunks are decoded once
/// all the same. Values are kept in what a conversion does not need to be quick, unless they are in memory
/// already. Throws as plan_memory() does.
MemoryShares share_memory(VolumeSource& source, const ConversionOptions& options, std::uint64_t resident,
                          std::size_t threads, bool may_hold);

}  // namespace weir
