#include "compressor/plan/memory_plan.h"

#include <algorithm>
#include <thread>

#include "compressor/encode/macrocell_builder.h"
#include "compressor/select/region_rows.h"
#include "compressor/select/tree_regions.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/layout/node_statistics.h"
#include "ingest/plan/staging.h"

namespace weir {
namespace {

// Per worker: stack, allocator arena, histogram or value table (512 KiB), buckets of keys (512 KiB), a region's steps
// (1.3 MiB; those of packed blocks are the region_bytes that callers give), leaves being encoded (700 KiB).
constexpr std::uint64_t kWorkerBytes = 4ULL << 20U;
// Code pages touched later, libraries' heaps, the head, one upper node's image, small layers of macrocells, and room
// for what no plan counts. A flat volume that is given the least ceiling, 64 MiB, was seen to take 36 MiB.
constexpr std::uint64_t kSlackBytes = 7ULL << 20U;
constexpr std::uint64_t kMiB = 1ULL << 20U;
constexpr std::uint64_t kLeastBlockBytes = kMiB;
// There are two blocks, and each has its rows, a 43rd of its size. A quarter of the remaining memory stays free for
// both passes' small buffers and for the allocator's waste.
constexpr std::uint64_t kBlockEighths = 3;

// Returns the bytes of everything except the workers.
std::uint64_t shared_bytes(std::uint64_t resident, const Box& domain) {
  const auto regions = static_cast<std::uint64_t>(make_lattice(domain, kLowerDim).size());
  // Two plans of the inner nodes while encodings are compared, later one with statistics and errors.
  const std::uint64_t tree =
      regions * (2 * sizeof(Region) + sizeof(NodeStatistics) + 32) + macrocell_window_bytes(domain);
  return resident + kSlackBytes + kStagingBytes + tree;
}

std::uint64_t fixed_bytes(std::uint64_t resident, std::size_t threads, const Box& domain) {
  return shared_bytes(resident, domain) + threads * kWorkerBytes;
}

}  // namespace

std::size_t processors_or_all(std::size_t given) {
  return given > 0 ? given : std::max(1U, std::thread::hardware_concurrency());
}

std::size_t choose_threads(std::size_t asked, std::size_t processors, std::uint64_t ceiling, std::uint64_t resident,
                           const Box& domain, std::uint64_t region_bytes) {
  if (asked > 0) return asked;
  const std::size_t most = std::max<std::size_t>(1, processors);
  const std::uint64_t others = shared_bytes(resident, domain) + 2 * kLeastBlockBytes;
  const std::uint64_t each = kWorkerBytes + region_bytes;
  if (others + most * each <= ceiling) return most;
  const std::uint64_t free = ceiling > others ? ceiling - others : 0;
  return std::clamp<std::size_t>(free / 4 * 3 / each, 1, most);
}

Message fewer_threads_notice(std::size_t threads, std::size_t processors, std::uint64_t ceiling) {
  return compose(option("memory", format_bytes(ceiling)), " holds ", threads, " of ", processors,
                 " threads; give more to use them all");
}

std::uint64_t least_ceiling(std::uint64_t resident, std::size_t threads, const Box& domain,
                            std::uint64_t region_bytes) {
  return fixed_bytes(resident, threads, domain) + 2 * kLeastBlockBytes + threads * region_bytes;
}

MemoryPlan plan_memory(std::uint64_t ceiling, std::uint64_t resident, std::size_t threads, const Box& domain,
                       std::uint64_t region_bytes, std::uint64_t records) {
  const std::uint64_t fixed = fixed_bytes(resident, threads, domain);
  const std::uint64_t least = least_ceiling(resident, threads, domain, region_bytes);
  if (ceiling < least) {
    // Rounded up, plus one MiB because the next process has other addresses.
    throw Error(ErrorKind::usage,
                compose(option("memory", format_bytes(ceiling)), " is too small for this volume with ", threads,
                        threads == 1 ? " thread" : " threads", "; give at least ", least / kMiB + 2, "MiB"));
  }
  MemoryPlan plan;
  if (records <= (ceiling - least) / 4) plan.record_bytes = records;
  const std::uint64_t free = ceiling - fixed - plan.record_bytes;
  plan.fixed_bytes = fixed;
  plan.block_bytes = std::max(kLeastBlockBytes, free / 8 * kBlockEighths);
  plan.worker_bytes = 2 * plan.block_bytes / threads;
  // Selection runs after the survey's blocks are freed.
  plan.selection.segment_regions =
      std::clamp<std::int64_t>(static_cast<std::int64_t>(free / 2 / (threads * region_bytes)), 1, 64);
  const std::uint64_t walk = static_cast<std::uint64_t>(plan.selection.segment_regions) * threads * region_bytes;
  plan.selection.step_bytes = free > walk ? (free - walk) / 2 : 0;
  return plan;
}

std::uint64_t ceiling_for_blocks(const MemoryPlan& plan, std::uint64_t ceiling, std::uint64_t block_bytes) {
  const std::uint64_t more = block_bytes > plan.block_bytes ? block_bytes - plan.block_bytes : 0;
  return ceiling + (more / kBlockEighths + 1) * 8;
}

}  // namespace weir
