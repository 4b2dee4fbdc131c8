#include "gpu/cuda/load/pageable_copy.h"

#include <algorithm>
#include <memory>

#include "gpu/cuda/runtime/check.h"

namespace weir {

CopyOutcome pageable_copy(const CopyTask& task) {
  constexpr std::uint64_t kMostBytes = 16ULL << 20U;
  const std::uint64_t piece_bytes = std::min({task.chunk_bytes, kMostBytes, task.bytes});
  const auto piece = std::make_unique_for_overwrite<std::byte[]>(piece_bytes);
  CopyOutcome outcome;
  for (std::uint64_t at = 0; at < task.bytes; at += piece_bytes) {
    task.check_cancelled();
    const std::uint64_t bytes = std::min(piece_bytes, task.bytes - at);
    {
      const StageClock clock(outcome.stages.populate_s);
      task.file.read(task.offset + at, {piece.get(), bytes});
    }
    const StageClock clock(outcome.stages.drain_s);
    check_cuda(cudaMemcpyAsync(task.target + at, piece.get(), bytes, cudaMemcpyHostToDevice, task.stream),
               "copying to the device");
    check_cuda(cudaStreamSynchronize(task.stream), "copying to the device");
  }
  return outcome;
}

}  // namespace weir
