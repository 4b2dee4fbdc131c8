// How the process's memory ceiling is divided. Every large buffer of a
// conversion has its share here; the test of the ceiling is the kernel's figure.
#pragma once

#include <cstddef>
#include <cstdint>

#include "compressor/select/region_rows.h"
#include "format/base/index.h"
#include "format/base/message.h"

namespace weir {

struct MemoryPlan {
  std::uint64_t block_bytes = 0;   ///< float32 bytes of one block; there is room for two, or several smaller ones
  std::uint64_t worker_bytes = 0;  ///< float32 bytes of one worker's block, if each worker reads its own
  SelectionRoom selection;
  std::uint64_t fixed_bytes = 0;   ///< bytes that do not depend on the blocks' size
  std::uint64_t record_bytes = 0;  ///< of the records of all leaves, which stay in memory; 0: records are spilled
};

/// Returns the least ceiling in bytes that plan_memory() accepts.
std::uint64_t least_ceiling(std::uint64_t resident, std::size_t threads, const Box& domain,
                            std::uint64_t region_bytes = kRegionRowsBytes);

/// Divides `ceiling` bytes for a domain and `threads` workers, with `resident` bytes already in use. A walk over
/// regions holds `region_bytes` of rows for each worker. The records of all leaves take `records` bytes. They stay in
/// memory if `records` is at most a quarter of the bytes above the least ceiling. 0: they are spilled.
/// Throws Error(usage) that names a sufficient --memory if `ceiling` is too small.
MemoryPlan plan_memory(std::uint64_t ceiling, std::uint64_t resident, std::size_t threads, const Box& domain,
                       std::uint64_t region_bytes = kRegionRowsBytes, std::uint64_t records = 0);

/// Returns `given`, or the number of the machine's processors if `given` is 0; at least 1.
std::size_t processors_or_all(std::size_t given);

/// Returns the number of workers of a conversion, at least 1: `asked`, whatever the ceiling. If `asked` is 0, one per
/// processor, or fewer if `ceiling` does not hold them: a quarter of what they share then stays for the blocks.
std::size_t choose_threads(std::size_t asked, std::size_t processors, std::uint64_t ceiling, std::uint64_t resident,
                           const Box& domain, std::uint64_t region_bytes = kRegionRowsBytes);

/// Returns one line for the user, for when choose_threads() chose fewer workers than processors.
Message fewer_threads_notice(std::size_t threads, std::size_t processors, std::uint64_t ceiling);

/// Returns the ceiling that leaves `block_bytes` for a block. Everything else stays as in `plan`, made for `ceiling`.
std::uint64_t ceiling_for_blocks(const MemoryPlan& plan, std::uint64_t ceiling, std::uint64_t block_bytes);

}  // namespace weir
