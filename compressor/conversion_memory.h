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

/// Bytes that selection holds for one region of 128^3: rows and, of packed blocks, ladders and steps (memory_plan.h).
std::uint64_t region_bytes(const ConversionOptions& options);

/// Most bytes that the records of all leaves of a volume over `domain` take at a time: rows, and what selection and
/// encoding add.
std::uint64_t record_bytes(const ConversionOptions& options, const Box& domain);

/// Who works on a conversion, beside what.
struct Workers {
  std::size_t processors = 1;  ///< of the machine, or as many as the options allow
  std::size_t threads = 1;
  std::uint64_t resident = 0;  ///< bytes in use whatever the threads do
};

/// With `held` bytes in use besides what the source and `coder`, which may be null, take. Throws as choose_threads()
/// does.
Workers choose_workers(VolumeSource& source, const ConversionOptions& options, const BlockCoder* coder,
                       std::uint64_t held);

/// Throws as choose_threads() and plan_memory() do where options.memory is too little for a volume over `domain`, with
/// `resident` bytes in use besides.
void check_memory(const ConversionOptions& options, const Box& domain, std::uint64_t resident);

/// How a conversion divides its memory, and what it reads by that.
struct MemoryShares {
  MemoryPlan memory;
  ReadingPlan reading;
  std::uint64_t cache_bytes = 0;  ///< for values that the survey caches for the encode pass (leaf_cache.h)
};

/// Of options.memory, of which `resident` bytes are in use. `may_hold`: records of leaves may stay in memory, since
/// nobody continues the conversion or takes part in it. They do where there is room, and where chunks are decoded once
/// all the same. Values that the survey caches get three quarters of what a conversion at full speed leaves over; none
/// where the source is in memory. Throws as plan_memory() does.
MemoryShares share_memory(VolumeSource& source, const ConversionOptions& options, std::uint64_t resident,
                          std::size_t threads, bool may_hold);

}  // namespace weir
