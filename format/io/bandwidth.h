// A limit on the bytes per second that a process reads and writes, so that a
// conversion leaves the file system to the simulation beside it.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>

#include "format/io/token_bucket.h"

namespace weir {

/// The steady clock, replaced in tests.
struct BandwidthClock {
  std::function<TokenBucket::Time()> now;
  std::function<void(TokenBucket::Time::duration)> sleep;
};

class Bandwidth {
 public:
  /// bytes_per_s above 0; a tenth of a second's bytes may be moved at once. Once `cancel`, if any, is set, nobody
  /// waits: whoever stops then has to bring what it began to an end, and to save it.
  Bandwidth(std::uint64_t bytes_per_s, const std::atomic<bool>* cancel, BandwidthClock clock);
  Bandwidth(std::uint64_t bytes_per_s, const std::atomic<bool>* cancel);

  /// `bytes` were read, or are about to be written: returns when that keeps to the limit. Any thread may call it; they
  /// share the limit.
  void spend(std::uint64_t bytes);

 private:
  const std::atomic<bool>* cancel_;
  BandwidthClock clock_;
  std::mutex mutex_;
  TokenBucket bucket_;
};

}  // namespace weir
