// The bounded memory that reading needs besides the caller's buffers.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <span>
#include <vector>

#include "ingest/files/input_file.h"
#include "ingest/plan/page_buffer.h"

namespace weir {

inline constexpr std::size_t kIoThreads = 4;                       ///< reads in flight for one box
inline constexpr std::size_t kPieceBytes = std::size_t{1} << 20U;  ///< bytes per read
/// All staging memory of one source, counted against --memory.
inline constexpr std::size_t kStagingBytes = kIoThreads * (kPieceBytes + 2 * kDirectAlignment);

/// kIoThreads buffers of one piece each, lent to readers. Thread-safe. Untouched buffers cost no memory.
class StagingPool {
 public:
  /// A buffer of kPieceBytes + 2 * kDirectAlignment bytes, page-aligned, given back on destruction.
  class Lease {
   public:
    explicit Lease(StagingPool& pool) : pool_(pool), bytes_(pool.acquire()) {}
    ~Lease() { pool_.release(bytes_); }
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;
    std::span<std::byte> bytes() const { return bytes_; }

   private:
    StagingPool& pool_;
    std::span<std::byte> bytes_;
  };

  StagingPool();

 private:
  std::span<std::byte> acquire();
  void release(std::span<std::byte> buffer);

  PageBuffer memory_;
  std::mutex mutex_;
  std::condition_variable returned_;
  std::vector<std::span<std::byte>> free_;
};

}  // namespace weir
