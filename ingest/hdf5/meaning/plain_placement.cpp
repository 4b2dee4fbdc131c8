#include "ingest/hdf5/meaning/plain_placement.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "ingest/hdf5/file/hdf5_attribute.h"

namespace weir {
namespace {

struct PlainName {
  const char* name;
  bool slowest_first = false;
  bool one_for_all = false;  ///< a single value counts
};

constexpr std::array kSpacings{PlainName{"spacing", false, true},   PlainName{"Spacing", false, true},
                               PlainName{"SPACING", false, true},   PlainName{"voxel_size", false, true},
                               PlainName{"VoxelSize", false, true}, PlainName{"voxelsize", false, true},
                               PlainName{"element_size_um", true},  PlainName{"resolution", true}};
constexpr std::array kOrigins{PlainName{"origin"}, PlainName{"Origin"}, PlainName{"ORIGIN"}, PlainName{"offset", true}};

// Slowest first.
std::optional<std::array<double, 3>> found_in(hid_t object, std::span<const PlainName> names) {
  for (const PlainName& candidate : names) {
    const std::vector<double> values = number_attribute(object, candidate.name);
    if (values.size() == 1 && candidate.one_for_all) return std::array{values[0], values[0], values[0]};
    if (values.size() != 3) continue;
    std::array<double, 3> ordered{values[0], values[1], values[2]};
    if (!candidate.slowest_first) std::reverse(ordered.begin(), ordered.end());
    return ordered;
  }
  return std::nullopt;
}

void fill(hid_t dataset, std::span<const Hdf5Handle> groups, std::span<const PlainName> names,
          std::span<AxisPlace> axes, std::optional<double> AxisPlace::*member) {
  auto values = found_in(dataset, names);
  for (std::size_t i = 0; i < groups.size() && !values; ++i) values = found_in(groups[i].get(), names);
  if (!values) return;
  for (std::size_t i = 0; i < 3; ++i) {
    auto& place = axes[i].*member;
    if (!place && !axes[i].is_time) place = (*values)[i];
  }
}

}  // namespace

void place_by_attributes(hid_t dataset, std::span<const Hdf5Handle> groups, std::span<AxisPlace> axes) {
  if (axes.size() < 3) return;
  fill(dataset, groups, kSpacings, axes.last(3), &AxisPlace::spacing);
  fill(dataset, groups, kOrigins, axes.last(3), &AxisPlace::origin);
}

}  // namespace weir
