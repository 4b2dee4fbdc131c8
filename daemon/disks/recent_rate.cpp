#include "daemon/disks/recent_rate.h"

#include <algorithm>

namespace weir {

void RecentRate::add(std::uint64_t bytes, Time now) {
  const std::int64_t number = slot_number(now);
  Slot& slot = slots_[static_cast<std::size_t>(number % kSlots)];
  if (slot.number != number) slot = {number, 0, 0};
  ++slot.count;
  slot.bytes += bytes;
}

RecentRate::Rates RecentRate::at(Time now) const {
  const std::int64_t present = slot_number(now);
  Rates sums;
  for (const Slot& slot : slots_) {
    if (slot.number < 0 || slot.number <= present - kSlots) continue;
    sums.per_s += static_cast<double>(slot.count);
    sums.bytes_per_s += static_cast<double>(slot.bytes);
  }
  // Divides by one slot at least: the events of the first moment do not give a rate per second.
  const auto over = std::clamp<std::chrono::nanoseconds>(now - start_, window_ / kSlots, window_);
  const double seconds = std::chrono::duration<double>(over).count();
  return {sums.per_s / seconds, sums.bytes_per_s / seconds};
}

}  // namespace weir
