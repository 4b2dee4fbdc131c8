// The recent rate of events and of their bytes, in constant memory.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>

namespace weir {

class RecentRate {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Rates are averages over the last `window`, or since `start` if that is shorter.
  RecentRate(std::chrono::seconds window, Time start) : window_(window), start_(start) {}

  void add(std::uint64_t bytes, Time now);

  struct Rates {
    double per_s = 0;
    double bytes_per_s = 0;
  };
  /// Returns the rates. They are accurate to one slot of the window.
  Rates at(Time now) const;

 private:
  static constexpr std::int64_t kSlots = 60;  ///< slots per window
  struct Slot {
    std::int64_t number = -1;  ///< number of the slot, counted since `start`
    std::uint64_t count = 0;
    std::uint64_t bytes = 0;
  };
  std::int64_t slot_number(Time now) const { return (now - start_) / (window_ / kSlots); }

  std::chrono::nanoseconds window_;
  Time start_;
  std::array<Slot, kSlots> slots_{};
};

}  // namespace weir
