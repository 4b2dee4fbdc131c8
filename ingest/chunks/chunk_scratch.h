// The bounded memory that chunks are decoded in.
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

/// What one chunk at a time is decoded in, between the buffers.
struct ChunkScratch {
  ChunkScratch(std::size_t buffer_bytes, bool two, std::size_t gathered_bytes = 0)
      : buffer(buffer_bytes), other(two ? buffer_bytes : 0), gathered(gathered_bytes) {}

  PageBuffer buffer;
  PageBuffer other;
  PageBuffer gathered;
  ChunkInflater inflater;
};

/// How large they are.
struct ScratchSize {
  std::size_t chunk_bytes = 0;     ///< of a decoded chunk, for messages
  std::size_t buffer_bytes = 0;    ///< of each buffer: the most a chunk takes at any stage
  bool two = false;                ///< `other` is used
  std::size_t codec_bytes = 0;     ///< that a library takes besides while it decodes one chunk
  std::size_t gathered_bytes = 0;  ///< of `gathered`: what is put together of several chunks, else 0
};

/// Scratch for several chunks at a time, lent to whoever decodes. Thread-safe; untouched scratch costs no
/// memory.
class ScratchPool {
 public:
  /// One scratch per core, or fewer, so that all fit an eighth of `memory` bytes; at least one. Throws
  /// Error(usage), beginning with `name` and naming a sufficient --memory, where one takes more than half.
  ScratchPool(const ScratchSize& size, std::uint64_t memory, const std::string& name);

  std::size_t size() const { return all_.size(); }
  /// Memory of all of them, in bytes.
  std::uint64_t bytes() const { return size() * scratch_bytes_; }

  /// Waits for a free one; given back on destruction. The holder must not wait for other tasks of TBB.
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
