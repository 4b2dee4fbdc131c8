#include "compressor/plan/reading_plan.h"

#include <algorithm>
#include <cmath>

#include "format/base/text.h"

namespace weir {

ReadingPlan plan_reading(const VolumeSource& source, const MemoryPlan& memory) {
  const Box domain = source.info().domain();
  const AccessShape access = source.access();
  // Read ahead: the survey writes nothing that asks for whole lower nodes, and of small blocks more can wait for the
  // work, each in the cache still where the disk is slower than that.
  constexpr std::uint64_t kSurveyBytes = std::uint64_t{8} << 20U;
  // In place: blocks for the second-level cache; deep ones for the encode pass, whose leaves then lie
  // together in the output. Larger volumes than this are not taken for cached.
  constexpr std::uint64_t kInPlaceSurveyBytes = std::uint64_t{1} << 20U;
  constexpr std::uint64_t kInPlaceEncodeBytes = std::uint64_t{2} << 20U;
  constexpr std::uint64_t kInPlaceVolumeBytes = std::uint64_t{64} << 30U;
  // In the room of two blocks: three with what is around them, each up to twice as large, and the file's pages.
  const std::uint64_t pair_bytes = memory.block_bytes / 4;
  const bool in_place =
      float32_bytes(domain) <= kInPlaceVolumeBytes && kInPlaceEncodeBytes <= memory.worker_bytes && source.in_memory();
  if (!in_place) {
    // Chunks are decoded many at a time, and once each where the blocks may be large enough.
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
  // A source may take more for its own work where there is more: up to an eighth.
  if (source.working_bytes() > 0) enough = enough / 7 * 8 + 8;
  return compose(source.info().path, ": its chunks of ", access.chunk.x, " x ", access.chunk.y, " x ", access.chunk.z,
                 " voxels do not fit the blocks of ", format_bytes(plan.block_bytes), " that ",
                 option("memory", format_bytes(ceiling)), " leaves, so that each is decoded ",
                 std::round(plan.amplification * 10) / 10, " times in a pass; ",
                 option("memory", cat((enough >> 20U) + 1, "MiB")), " decodes it once");
}

}  // namespace weir
