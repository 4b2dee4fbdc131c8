#include "compressor/push/plane_set.h"

#include <algorithm>

#include "format/base/text.h"

namespace weir {

std::optional<PlaneRange> PlaneSet::add(const PlaneRange& planes) {
  auto next = ranges_.upper_bound(planes.lo);
  auto before = next == ranges_.begin() ? ranges_.end() : std::prev(next);
  if (before != ranges_.end() && before->second > planes.lo) {
    return PlaneRange{planes.lo, std::min(before->second, planes.hi)};
  }
  if (next != ranges_.end() && next->first < planes.hi) {
    return PlaneRange{next->first, std::min(next->second, planes.hi)};
  }
  std::int64_t hi = planes.hi;
  if (next != ranges_.end() && next->first == hi) {
    hi = next->second;
    ranges_.erase(next);
  }
  if (before != ranges_.end() && before->second == planes.lo) {
    before->second = hi;
  } else {
    ranges_.emplace(planes.lo, hi);
  }
  return std::nullopt;
}

std::vector<PlaneRange> PlaneSet::missing(std::int64_t count) const {
  std::vector<PlaneRange> missing;
  std::int64_t at = 0;
  for (const auto& [lo, hi] : ranges_) {
    if (at < lo) missing.push_back({at, lo});
    at = hi;
  }
  if (at < count) missing.push_back({at, count});
  return missing;
}

std::string planes_text(const std::vector<PlaneRange>& ranges) {
  constexpr std::size_t kNamed = 3;
  const std::size_t named = std::min(kNamed, ranges.size());
  std::int64_t planes = 0;
  std::int64_t more = 0;
  std::string list;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const auto [lo, hi] = ranges[i];
    planes += hi - lo;
    if (i >= named) {
      more += hi - lo;
      continue;
    }
    const bool last = i + 1 == ranges.size();
    list += i == 0 ? "" : (last ? " and " : ", ");
    list += hi - lo == 1 ? cat(lo) : cat(lo, " to ", hi - 1);
  }
  return cat(planes == 1 ? "plane " : "planes ", list, more > 0 ? cat(" and ", more, " more") : "");
}

}  // namespace weir
