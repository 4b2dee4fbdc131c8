#include "compressor/plan/reading_plan.h"

#include <algorithm>
#include <cmath>

#include "format/base/text.h"

namespace weir {

ReadingPlan plan_reading(const VolumeSource& source, const MemoryPlan& memory) {
  const Box domain = source.info().domain();
  const AccessShape access = source.access();
  // Read ahead: the survey's output does not need whole lower nodes, so its blocks may be small. More small blocks can
  // wait for the workers, and each is still in the cache if the disk is slower than the workers.
  constexpr std::uint64_t kSurveyBytes = std::uint64_t{8} << 20U;
  // In place: blocks fit the second-level cache. The encode pass gets deep blocks, so that a block's leaves lie
  // together in the output. Volumes larger than kInPlaceVolumeBytes are not assumed to be cached.
  constexpr std::uint64_t kInPlaceSurveyBytes = std::uint64_t{1} << 20U;
  constexpr std::uint64_t kInPlaceEncodeBytes = std::uint64_t{2} << 20U;
  constexpr std::uint64_t kInPlaceVolumeBytes = std::uint64_t{64} << 30U;
  // The room of two blocks holds three blocks with their surroundings, each up to twice as large, and the file's pages.
  const std::uint64_t pair_bytes = memory.block_bytes / 4;
  const bool in_place =
      float32_bytes(domain) <= kInPlaceVolumeBytes && kInPlaceEncodeBytes <= memory.worker_bytes && source.in_memory();
  if (!in_place) {
    // Many chunks are decoded at a time, and each only once if the blocks may be large enough.
    const bool chunked = access.chunk != Index3{};
    const std::uint64_t survey_bytes = chunked ? memory.block_bytes : std::min(memory.block_bytes, kSurveyBytes);
    return {Reading::ahead, plan_blocks(domain, access, survey_bytes), plan_blocks(domain, access, memory.block_bytes),
            pair_bytes};
  }
  return {Reading::in_place, plan_blocks(domain, access, kInPlaceSurveyBytes),
          plan_blocks(domain, access, kInPlaceEncodeBytes, BlockShape::deep), pair_bytes};
}

Message amplification_notice(const VolumeSource& source, const MemoryPlan& memory, std::uint64_t ceiling,
                             const BlockPlan& plan) {
  const AccessShape access = source.access();
  std::uint64_t enough = ceiling_for_blocks(memory, ceiling, bytes_for_whole_chunks(source.info().domain(), access));
  // A source may take up to an eighth of a larger ceiling for its own work.
  if (source.working_bytes() > 0) enough = enough / 7 * 8 + 8;
  return compose(source.info().path, ": its chunks of ", access.chunk.x, " x ", access.chunk.y, " x ", access.chunk.z,
                 " voxels do not fit the blocks of ", format_bytes(plan.block_bytes), " that ",
                 option("memory", format_bytes(ceiling)), " leaves, so that each is decoded ",
                 std::round(plan.amplification * 10) / 10, " times in a pass; ",
                 option("memory", cat((enough >> 20U) + 1, "MiB")), " decodes it once");
}

}  // namespace weir
