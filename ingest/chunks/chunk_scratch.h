// The bounded memory for decoding chunks.
#pragma once

#include <tbb/concurrent_queue.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ingest/chunks/chunk_inflater.h"
#include "ingest/plan/page_buffer.h"

namespace weir {

/// The memory for decoding one chunk at a time. Filters work from one buffer into the other.
struct ChunkScratch {
  ChunkScratch(std::size_t buffer_bytes, bool two, std::size_t gathered_bytes = 0)
      : buffer(buffer_bytes), other(two ? buffer_bytes : 0), gathered(gathered_bytes) {}

  PageBuffer buffer;
  PageBuffer other;
  PageBuffer gathered;
  ChunkInflater inflater;
};

/// Sizes of the buffers of a ChunkScratch.
struct ScratchSize {
  std::size_t chunk_bytes = 0;     ///< size of a decoded chunk, for messages
  std::size_t buffer_bytes = 0;    ///< size of each buffer: the most that a chunk takes at any stage
  bool two = false;                ///< `other` is used
  std::size_t codec_bytes = 0;     ///< bytes that a library takes besides while it decodes one chunk
  std::size_t gathered_bytes = 0;  ///< size of `gathered`, which is put together from several chunks; else 0
};

/// Scratch for several chunks at a time, lent to decoders. Thread-safe. Untouched scratch costs no memory.
class ScratchPool {
 public:
  /// Makes one scratch per core, or fewer, so that all fit an eighth of `memory` bytes; at least one. Throws
  /// Error(usage), beginning with `name` and naming a sufficient --memory, if one scratch takes more than half.
  ScratchPool(const ScratchSize& size, std::uint64_t memory, const std::string& name);

  std::size_t size() const { return all_.size(); }
  /// Returns the bytes of all scratch together.
  std::uint64_t bytes() const { return size() * scratch_bytes_; }

  /// Waits for a free scratch and returns it to the pool on destruction. The holder must not wait for other TBB
  /// tasks.
  class Lease {
   public:
    explicit Lease(ScratchPool& pool) : pool_(pool) { pool_.free_.pop(scratch_); }
    ~Lease() { pool_.free_.push(scratch_); }
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;
    ChunkScratch& operator*() const { return *scratch_; }

   private:
    ScratchPool& pool_;
    ChunkScratch* scratch_ = nullptr;
  };

 private:
  std::uint64_t scratch_bytes_;
  std::vector<std::unique_ptr<ChunkScratch>> all_;
  tbb::concurrent_bounded_queue<ChunkScratch*> free_;
};

}  // namespace weir
