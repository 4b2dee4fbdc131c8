// The recent rate of something, in numbers and in bytes, in constant memory.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>

namespace weir {

class RecentRate {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Rates are over `window` before now, and since `start` where that is shorter.
  RecentRate(std::chrono::seconds window, Time start) : window_(window), start_(start) {}

  void add(std::uint64_t bytes, Time now);

  struct Rates {
    double per_s = 0;
    double bytes_per_s = 0;
  };
  /// Exact to one slot, a kSlots-th of the window.
  Rates at(Time now) const;

 private:
  static constexpr std::int64_t kSlots = 60;  ///< of the window
  struct Slot {
    std::int64_t number = -1;  ///< since `start`
    std::uint64_t count = 0;
    std::uint64_t bytes = 0;
  };
  std::int64_t slot_number(Time now) const { return (now - start_) / (window_ / kSlots); }

  std::chrono::nanoseconds window_;
  Time start_;
  std::array<Slot, kSlots> slots_{};
};

}  // namespace weir
