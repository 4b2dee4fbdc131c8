// A limit on the bytes per second that a process reads and writes, so that a
// conversion leaves the file system to the simulation beside it.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>

namespace weir {

/// Tokens, one a byte, come in at a fixed rate until the bucket is full. Moving bytes takes as many tokens,
/// more than there are if need be, and the next call waits until that debt is paid. So pieces of any size keep to the
/// rate in the long run, and are never ahead of it by more than the bucket holds and one piece.
class TokenBucket {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Full at `now`. Both above 0.
  TokenBucket(double bytes_per_s, double capacity_bytes, Time now)
      : rate_(bytes_per_s), capacity_(capacity_bytes), tokens_(capacity_bytes), at_(now) {}

  /// Takes `bytes` at `now`, which is not before that of the last call (an earlier one counts as that). Returns when
  /// the debt will be paid, `now` where there is none.
  Time take(std::uint64_t bytes, Time now);

 private:
  double rate_;
  double capacity_;
  double tokens_;  ///< at at_; below 0: a debt
  Time at_;
};

/// The steady clock, replaced in tests.
struct BandwidthClock {
  std::function<TokenBucket::Time()> now;
  std::function<void(TokenBucket::Time::duration)> sleep;
};

class Bandwidth {
 public:
  /// bytes_per_s above 0; a tenth of a second's bytes may be moved at once. Once `cancel`, if any, is set, no call
  /// waits, so that work that stops can finish and save what it began.
  Bandwidth(std::uint64_t bytes_per_s, const std::atomic<bool>* cancel, BandwidthClock clock);
  Bandwidth(std::uint64_t bytes_per_s, const std::atomic<bool>* cancel);

  /// Call it after reading or before writing `bytes`: returns when that keeps to the limit. Any thread may call it;
  /// they share the limit.
  void spend(std::uint64_t bytes);

 private:
  const std::atomic<bool>* cancel_;
  BandwidthClock clock_;
  std::mutex mutex_;
  TokenBucket bucket_;
};

}  // namespace weir
