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
  std::uint64_t worker_bytes = 0;  ///< of one worker's block where each reads its own
  SelectionRoom selection;
  std::uint64_t fixed_bytes = 0;   ///< taken however long the blocks are
  std::uint64_t record_bytes = 0;  ///< of the records of all leaves, which are not spilled; 0: they are
};

/// The least ceiling that plan_memory() divides.
std::uint64_t least_ceiling(std::uint64_t resident, std::size_t threads, const Box& domain,
                            std::uint64_t region_bytes = kRegionRowsBytes);

/// Divides `ceiling` bytes for a domain and `threads` workers, with `resident` bytes already in use.
/// A walk over regions holds `region_bytes` of rows for each. The records of all leaves take
/// `records` bytes, 0: they are spilled; they stay in memory if that is at most a quarter of what is to be divided.
/// Throws Error(usage) naming a sufficient --memory where it is too small.
MemoryPlan plan_memory(std::uint64_t ceiling, std::uint64_t resident, std::size_t threads, const Box& domain,
                       std::uint64_t region_bytes = kRegionRowsBytes, std::uint64_t records = 0);

/// `given`, or where that is 0 those of the machine; at least 1.
std::size_t processors_or_all(std::size_t given);

/// Workers of a conversion: `asked`, or where that is 0 one for each of the machine's `processors`, and fewer where
/// `ceiling` does not hold them: then a quarter of what they share stays for the blocks. At least 1.
std::size_t choose_threads(std::size_t asked, std::size_t processors, std::uint64_t ceiling, std::uint64_t resident,
                           const Box& domain, std::uint64_t region_bytes = kRegionRowsBytes);

/// One line for the user where it chose fewer.
Message fewer_threads_notice(std::size_t threads, std::size_t processors, std::uint64_t ceiling);

/// The ceiling that leaves `block_bytes` for a block, all else as `plan`, made for `ceiling`, has it.
std::uint64_t ceiling_for_blocks(const MemoryPlan& plan, std::uint64_t ceiling, std::uint64_t block_bytes);

}  // namespace weir
