// The memory that a conversion's options make it take, besides the blocks that it reads.
#pragma once

#include <cstddef>
#include <cstdint>

#include "compressor/conversion_options.h"
#include "compressor/plan/memory_plan.h"
#include "compressor/plan/reading_plan.h"
#include "format/base/index.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Returns the bytes that selection holds for one region of 128^3 voxels: rows and, for packed blocks, ladders and
/// steps (memory_plan.h).
std::uint64_t region_bytes(const ConversionOptions& options);

/// Returns the most bytes that the records of all leaves over `domain` take at a time: rows, and the records that
/// selection and encoding add.
std::uint64_t record_bytes(const ConversionOptions& options, const Box& domain);

/// The threads of a conversion, and the memory that is in use besides them.
struct Workers {
  std::size_t processors = 1;  ///< options.processors, or all of the machine's
  std::size_t threads = 1;
  std::uint64_t resident = 0;  ///< bytes in use that do not depend on the threads
};

/// Chooses the number of threads. `held` is the bytes in use besides the memory of `source` and `coder`. `coder` may
/// be null.
Workers choose_workers(VolumeSource& source, const ConversionOptions& options, const BlockCoder* coder,
                       std::uint64_t held);

/// Throws as plan_memory() does if options.memory is too little for a volume over `domain`, with `resident` bytes
/// already in use.
void check_memory(const ConversionOptions& options, const Box& domain, std::uint64_t resident);

/// How a conversion divides its memory, and the blocks that it reads as a result.
struct MemoryShares {
  MemoryPlan memory;
  ReadingPlan reading;
  std::uint64_t cache_bytes = 0;  ///< for values that the survey caches for the encode pass (leaf_cache.h)
};

/// Divides options.memory, of which `resident` bytes are in use. `may_hold`: records of leaves may stay in memory,
/// because no journal continues the conversion and no other rank takes part in it. They stay if there is room, and if
/// chunks are still decoded once. The survey's cache gets three quarters of the memory that a conversion at full speed
/// leaves over, and nothing if the source is in memory. Throws as plan_memory() does.
MemoryShares share_memory(VolumeSource& source, const ConversionOptions& options, std::uint64_t resident,
                          std::size_t threads, bool may_hold);

}  // namespace weir
