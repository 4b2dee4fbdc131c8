#include "ingest/amrex/range_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "format/base/load_scalar.h"
#include "format/base/scalar_type.h"
#include "format/base/text.h"

namespace weir {
namespace {

/// Tolerance, relative to the larger of the two bounds: some codes write bounds with six digits, and the values as
/// float32.
constexpr double kSlack = 1e-5;

/// Returns `value` rounded to the stored type; infinite if it is too large for it.
template <typename Stored>
Stored rounded_bound(double value) {
  constexpr auto kMost = static_cast<double>(std::numeric_limits<Stored>::max());
  constexpr Stored kInfinity = std::numeric_limits<Stored>::infinity();
  return value > kMost ? kInfinity : value < -kMost ? -kInfinity : static_cast<Stored>(value);
}

/// Returns the first value outside `range`; NaN if there is none. NaN lies in any range.
template <typename Stored, typename Bits, bool BigEndian>
double first_outside(std::span<const std::byte> values, const ComponentRange& range) {
  const double slack = kSlack * std::max(std::fabs(range.min), std::fabs(range.max));
  const auto least = rounded_bound<Stored>(range.min - slack);
  const auto most = rounded_bound<Stored>(range.max + slack);
  const auto value = [&](std::size_t i) { return load_scalar<Stored>(values.data() + i * sizeof(Stored), BigEndian); };
  const std::size_t count = values.size() / sizeof(Stored);
  Bits outside = 0;
  for (std::size_t i = 0; i < count; ++i)
    outside |= static_cast<Bits>(value(i) < least) | static_cast<Bits>(value(i) > most);
  for (std::size_t i = 0; outside != 0 && i < count; ++i) {
    if (value(i) < least || value(i) > most) return static_cast<double>(value(i));
  }
  return std::numeric_limits<double>::quiet_NaN();
}

double first_outside(const RealLayout& layout, std::span<const std::byte> values, const ComponentRange& range) {
  if (layout.type == ScalarType::float32) {
    return layout.big_endian ? first_outside<float, std::uint32_t, true>(values, range)
                             : first_outside<float, std::uint32_t, false>(values, range);
  }
  return layout.big_endian ? first_outside<double, std::uint64_t, true>(values, range)
                           : first_outside<double, std::uint64_t, false>(values, range);
}

}  // namespace

RangeCheck::RangeCheck(const Plotfile& plotfile, std::size_t component, Notice notice)
    : plotfile_(plotfile), component_(component), notice_(std::move(notice)), looks_(static_cast<bool>(notice_)) {}

void RangeCheck::look_at(std::size_t level, std::uint32_t fab, const std::string& file,
                         std::span<const std::byte> values) {
  const std::vector<ComponentRange>& ranges = plotfile_.levels[level].box_ranges;
  if (!looks_.load(std::memory_order_relaxed) || ranges.empty()) return;
  const double value = first_outside(plotfile_.layout, values, ranges[fab]);
  if (std::isnan(value) || !looks_.exchange(false)) return;
  notice_(cat(file, ": box ", box_in_file(plotfile_, level, fab), " has ", value, " in ",
              plotfile_.header.components[component_], ", and by ", cell_header_path(plotfile_, level), " it has from ",
              ranges[fab].min, " to ", ranges[fab].max,
              "; the values are taken as they are, but one of the two files may be of another plotfile: if so, copy it "
              "again"));
}

}  // namespace weir
