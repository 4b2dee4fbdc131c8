#include "gpu/cuda/load/pinned_ring.h"

#include <array>
#include <cstddef>
#include <vector>

#include "gpu/cuda/load/copy_event.h"
#include "gpu/cuda/load/parallel_read.h"
#include "gpu/cuda/runtime/check.h"

namespace weir {
namespace {

constexpr std::size_t kBuffersPerThread = 2;

struct ThreadState {
  std::array<CopyEvent, kBuffersPerThread> copied;
  std::size_t turn = 0;
  double read_s = 0;
  double copy_wait_s = 0;
};

}  // namespace

std::optional<PinnedRing> PinnedRing::make(std::uint64_t piece_bytes, int threads, std::string& refusal) {
  auto memory = PinnedMemory::make(piece_bytes * static_cast<std::uint64_t>(threads) * kBuffersPerThread, refusal);
  if (!memory) return std::nullopt;
  return PinnedRing(std::move(*memory), piece_bytes, threads);
}

LoadStages PinnedRing::copy(const CopyTask& task) {
  std::vector<ThreadState> states(static_cast<std::size_t>(threads_));
  const auto take = [&](int thread, const FilePiece& piece) {
    const auto t = static_cast<std::size_t>(thread);
    ThreadState& state = states[t];
    const std::size_t turn = state.turn++ % kBuffersPerThread;
    std::byte* const buffer = memory_.data() + (t * kBuffersPerThread + turn) * piece_bytes_;
    {
      const StageClock clock(state.copy_wait_s);
      state.copied[turn].wait();
    }
    {
      const StageClock clock(state.read_s);
      task.file.read(task.offset + piece.offset, {buffer, piece.bytes});
    }
    check_cuda(cudaMemcpyAsync(task.target + piece.offset, buffer, piece.bytes, cudaMemcpyHostToDevice, task.stream),
               "copying to the device");
    state.copied[turn].record(task.stream);
  };
  LoadStages stages;
  try {
    for_each_piece(task, piece_bytes_, threads_, take);
  } catch (...) {
    if (cudaStreamSynchronize(task.stream) != cudaSuccess) cudaGetLastError();  // the failure is known already
    throw;
  }
  {
    const StageClock clock(stages.drain_s);
    check_cuda(cudaStreamSynchronize(task.stream), "copying to the device");
  }
  for (const ThreadState& state : states) {
    stages.populate_s += state.read_s;
    stages.copy_wait_s += state.copy_wait_s;
  }
  return stages;
}

}  // namespace weir
