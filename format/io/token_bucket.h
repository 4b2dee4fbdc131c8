// The arithmetic of a limit on bytes per second.
#pragma once

#include <chrono>
#include <cstdint>

namespace weir {

/// Tokens, one a byte, come in at a fixed rate until the bucket is full. Who moves bytes takes as many, more than
/// there are if need be, and the next one waits until that debt is paid: so pieces of any size keep to the rate in
/// the long run, and at no time is more ahead of it than the bucket holds and one piece.
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

}  // namespace weir
