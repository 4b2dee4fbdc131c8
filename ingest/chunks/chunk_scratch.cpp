#include "ingest/chunks/chunk_scratch.h"

#include <algorithm>
#include <thread>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/plan/conversion_bytes.h"

namespace weir {
namespace {

/// zlib's own state: 7 KiB and a window of 32 KiB.
constexpr std::uint64_t kInflaterBytes = 40 * 1024;
/// All scratch together takes at most 1/8 of --memory. More would be lost to the blocks, and larger blocks save more
/// decodes.
constexpr std::uint64_t kScratchShare = 8;

}  // namespace

ScratchPool::ScratchPool(const ScratchSize& size, std::uint64_t memory, const std::string& name)
    : scratch_bytes_((size.two ? 2 : 1) * std::uint64_t{size.buffer_bytes} + size.codec_bytes + size.gathered_bytes +
                     kInflaterBytes) {
  if (scratch_bytes_ > memory / 2) {
    throw Error(ErrorKind::usage,
                compose(name, ": decoding one of its chunks of ", format_bytes(size.chunk_bytes), " takes ",
                        format_bytes(scratch_bytes_), ", more than half of ", option("memory", format_bytes(memory)),
                        "; give at least ", memory_beside_conversion(scratch_bytes_)));
  }
  const std::uint64_t cores = std::max(1U, std::thread::hardware_concurrency());
  const std::uint64_t count = std::clamp<std::uint64_t>(memory / kScratchShare / scratch_bytes_, 1, cores);
  for (std::uint64_t i = 0; i < count; ++i) {
    all_.push_back(std::make_unique<ChunkScratch>(size.buffer_bytes, size.two, size.gathered_bytes));
    free_.push(all_.back().get());
  }
}

}  // namespace weir
