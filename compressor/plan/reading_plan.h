// How the two passes of a conversion read their source: ahead or in place, and
// in which blocks.
#pragma once

#include <cstdint>

#include "compressor/plan/memory_plan.h"
#include "format/base/message.h"
#include "ingest/plan/block_plan.h"
#include "ingest/plan/block_stream.h"
#include "ingest/source/volume_source.h"

namespace weir {

struct ReadingPlan {
  Reading reading = Reading::ahead;
  BlockPlan survey;
  BlockPlan encode;
  /// CompareOptions::block_bytes of the pass over source and file that comes after both passes.
  std::uint64_t pair_bytes = 0;
};

ReadingPlan plan_reading(const VolumeSource& source, const MemoryPlan& memory);

/// Returns a notice such as "each is decoded 4 times in a pass". It says what `ceiling` costs if it is too small for
/// whole chunks. `plan` is the plan that was made for `ceiling`.
Message amplification_notice(const VolumeSource& source, const MemoryPlan& memory, std::uint64_t ceiling,
                             const BlockPlan& plan);

}  // namespace weir
