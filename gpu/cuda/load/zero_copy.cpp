#include "gpu/cuda/load/zero_copy.h"

#include <unistd.h>

#include <mutex>
#include <utility>

#include "format/process/page_size.h"
#include "gpu/cuda/load/parallel_read.h"

namespace weir {
namespace {

// Calls take(piece) for all of the task's range, in parallel. Adds the seconds of all calls to `sum`.
template <class Take>
void for_each_piece_timed(const CopyTask& task, double& sum, Take take) {
  std::mutex mutex;
  for_each_piece(task, task.chunk_bytes, task.threads, [&](int, const FilePiece& piece) {
    double seconds = 0;
    {
      const StageClock clock(seconds);
      take(piece);
    }
    const std::lock_guard lock(mutex);
    sum += seconds;
  });
}

}  // namespace

std::optional<ZeroCopyRange> ZeroCopyRange::make(const CopyTask& task, bool own_pages, std::string& refusal,
                                                 LoadStages& stages) {
  if (own_pages) {
    for_each_piece_timed(task, stages.populate_s,
                         [&](const FilePiece& piece) { task.file.populate(task.offset + piece.offset, piece.bytes); });
    const std::uint64_t begin = round_down_to_page(task.offset);
    const std::uint64_t end = round_up_to_page(task.offset + task.bytes);
    const StageClock clock(stages.register_s);
    auto range =
        RegisteredRange::make({task.file.bytes().data() + begin, end - begin}, RegisteredRange::Use::in_place, refusal);
    if (!range) {
      task.file.check_unchanged();  // pages that are gone cannot be locked either
      return std::nullopt;
    }
    const std::byte* const data = range->device_address() + (task.offset - begin);
    return ZeroCopyRange(std::move(*range), data);
  }
  std::optional<PinnedMemory> copy;
  {
    const StageClock clock(stages.register_s);
    copy = PinnedMemory::make(task.bytes, refusal);
  }
  if (!copy) return std::nullopt;
  for_each_piece_timed(task, stages.populate_s, [&](const FilePiece& piece) {
    task.file.read(task.offset + piece.offset, {copy->data() + piece.offset, piece.bytes});
  });
  const std::byte* const data = copy->device_address();
  return ZeroCopyRange(std::move(*copy), data);
}

}  // namespace weir
