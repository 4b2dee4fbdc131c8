#include "format/io/bandwidth.h"

#include <algorithm>
#include <thread>
#include <utility>

namespace weir {
namespace {

/// Seconds of the rate that may be moved at once after a pause.
constexpr double kBurst_s = 0.1;
/// The longest sleep, and so the longest time until a cancellation is noticed.
constexpr std::chrono::milliseconds kNap{100};

}  // namespace

Bandwidth::Bandwidth(std::uint64_t bytes_per_s, const std::atomic<bool>* cancel, BandwidthClock clock)
    : cancel_(cancel),
      clock_(std::move(clock)),
      bucket_(static_cast<double>(bytes_per_s), kBurst_s * static_cast<double>(bytes_per_s), clock_.now()) {}

Bandwidth::Bandwidth(std::uint64_t bytes_per_s, const std::atomic<bool>* cancel)
    : Bandwidth(bytes_per_s, cancel,
                {std::chrono::steady_clock::now, [](auto time) { std::this_thread::sleep_for(time); }}) {}

void Bandwidth::spend(std::uint64_t bytes) {
  TokenBucket::Time now = clock_.now();
  const TokenBucket::Time until = [&] {
    const std::scoped_lock lock(mutex_);
    return bucket_.take(bytes, now);
  }();
  for (; now < until; now = clock_.now()) {
    if (cancel_ != nullptr && *cancel_) return;
    clock_.sleep(std::min<TokenBucket::Time::duration>(kNap, until - now));
  }
}

using Seconds = std::chrono::duration<double>;

TokenBucket::Time TokenBucket::take(std::uint64_t bytes, Time now) {
  const Time then = std::max(at_, now);
  tokens_ = std::min(capacity_, tokens_ + Seconds(then - at_).count() * rate_) - static_cast<double>(bytes);
  at_ = then;
  if (tokens_ >= 0) return now;
  // A wait of centuries (a terabyte at a byte a second) must not overflow the clock.
  const Seconds longest(1e9);
  return then + std::chrono::ceil<Time::duration>(std::min(longest, Seconds(-tokens_ / rate_)));
}

}  // namespace weir
