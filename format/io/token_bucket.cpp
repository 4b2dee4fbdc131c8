#include "format/io/token_bucket.h"

#include <algorithm>

namespace weir {

using Seconds = std::chrono::duration<double>;

TokenBucket::Time TokenBucket::take(std::uint64_t bytes, Time now) {
  const Time then = std::max(at_, now);
  tokens_ = std::min(capacity_, tokens_ + Seconds(then - at_).count() * rate_) - static_cast<double>(bytes);
  at_ = then;
  if (tokens_ >= 0) return now;
  // What would take centuries (a terabyte at a byte a second) must not overflow the clock.
  const Seconds longest(1e9);
  return then + std::chrono::ceil<Time::duration>(std::min(longest, Seconds(-tokens_ / rate_)));
}

}  // namespace weir
