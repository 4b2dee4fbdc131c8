// A limit on the bytes per second that a process reads and writes, so that a conversion leaves bandwidth of the file
// system to a simulation that runs beside it.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>

namespace weir {

/// A token bucket: one token is one byte. Tokens come in at a fixed rate until the bucket is full. Moving bytes takes
/// as many tokens, even more than the bucket holds; the next call then waits until that debt is paid. So pieces of any
/// size keep to the rate in the long run, and never run ahead of it by more than the bucket's capacity and one piece.
class TokenBucket {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// The bucket is full at `now`. `bytes_per_s` and `capacity_bytes` are above 0.
  TokenBucket(double bytes_per_s, double capacity_bytes, Time now)
      : rate_(bytes_per_s), capacity_(capacity_bytes), tokens_(capacity_bytes), at_(now) {}

  /// Takes `bytes` tokens at `now`. A `now` before the last call's counts as the last call's. Returns when the debt
  /// will be paid; returns `now` if there is no debt.
  Time take(std::uint64_t bytes, Time now);

 private:
  double rate_;
  double capacity_;
  double tokens_;  ///< tokens at the time at_; below 0: a debt
  Time at_;
};

/// The steady clock, replaced in tests.
struct BandwidthClock {
  std::function<TokenBucket::Time()> now;
  std::function<void(TokenBucket::Time::duration)> sleep;
};

class Bandwidth {
 public:
  /// `bytes_per_s` is above 0; a tenth of a second's bytes may be moved at once. Once `cancel` (may be null) is set, no
  /// call waits, so that work that is being cancelled can finish and save what it began.
  Bandwidth(std::uint64_t bytes_per_s, const std::atomic<bool>* cancel, BandwidthClock clock);
  Bandwidth(std::uint64_t bytes_per_s, const std::atomic<bool>* cancel);

  /// Waits until moving `bytes` keeps to the limit. Call it after reading or before writing them. Any thread may call
  /// it; all threads share the limit.
  void spend(std::uint64_t bytes);

 private:
  const std::atomic<bool>* cancel_;
  BandwidthClock clock_;
  std::mutex mutex_;
  TokenBucket bucket_;
};

}  // namespace weir
