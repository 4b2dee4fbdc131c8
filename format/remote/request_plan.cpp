#include "format/remote/request_plan.h"

#include <algorithm>

namespace weir {
namespace {

// Joins ranges with a gap below `gap` between them; `ranges` are sorted.
std::vector<ByteRange> joined(const std::vector<ByteRange>& ranges, std::uint64_t gap) {
  std::vector<ByteRange> all;
  for (const ByteRange& range : ranges) {
    if (!all.empty() && (range.offset <= all.back().end() || range.offset - all.back().end() < gap)) {
      all.back().bytes = std::max(all.back().end(), range.end()) - all.back().offset;
    } else {
      all.push_back(range);
    }
  }
  return all;
}

}  // namespace

std::vector<ByteRange> plan_requests(std::vector<ByteRange> wanted, std::size_t most) {
  std::erase_if(wanted, [](const ByteRange& range) { return range.bytes == 0; });
  std::ranges::sort(wanted, {}, &ByteRange::offset);
  std::vector<ByteRange> plan = joined(wanted, kShortestGap);
  if (plan.size() <= most) return plan;
  std::vector<std::uint64_t> gaps;
  for (std::size_t i = 1; i < plan.size(); ++i) gaps.push_back(plan[i].offset - plan[i - 1].end());
  std::ranges::sort(gaps, std::greater<>());
  // The most - 1 longest gaps stay; gaps of equal length may all be closed.
  return joined(plan, most == 1 ? gaps.front() + 1 : gaps[most - 1] + 1);
}

}  // namespace weir
