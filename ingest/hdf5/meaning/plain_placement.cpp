#include "ingest/hdf5/meaning/plain_placement.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "format/base/text.h"
#include "ingest/hdf5/file/hdf5_attribute.h"

namespace weir {
namespace {

using Triple = std::array<double, 3>;  // slowest axis first
using PlacedMember = std::optional<double> AxisPlace::*;
using SourceMember = std::string AxisPlace::*;

struct PlainName {
  const char* name;
  bool slowest_first = false;
  bool one_for_all = false;    ///< a single value counts
  bool is_ambiguous = false;   ///< it may mean a number of cells: of the dataset alone, and never its extents
  bool is_convention = false;  ///< some programs' habit, not a format's rule: spacing_note then names the attribute
};

constexpr std::array kSpacings{PlainName{"spacing", false, true},
                               PlainName{"Spacing", false, true},
                               PlainName{"SPACING", false, true},
                               PlainName{"voxel_size", false, true, false, true},
                               PlainName{"VoxelSize", false, true, false, true},
                               PlainName{"voxelsize", false, true, false, true},
                               PlainName{"element_size_um", true, false, false, true},
                               PlainName{"resolution", true, false, true, true}};
constexpr std::array kOrigins{PlainName{"origin"}, PlainName{"Origin"}, PlainName{"ORIGIN"}, PlainName{"offset", true}};

struct FoundPlace {
  Triple values;
  const PlainName* name;
};

bool are_extents(Triple values, std::span<const AxisPlace> axes) {
  const auto is_extent = [](double value, const AxisPlace& axis) { return value == static_cast<double>(axis.extent); };
  const bool in_order = std::equal(values.begin(), values.end(), axes.begin(), is_extent);
  std::reverse(values.begin(), values.end());
  return in_order || std::equal(values.begin(), values.end(), axes.begin(), is_extent);
}

std::optional<FoundPlace> found_in(hid_t object, bool is_dataset, std::span<const PlainName> names,
                                   std::span<const AxisPlace> axes) {
  for (const PlainName& candidate : names) {
    if (candidate.is_ambiguous && !is_dataset) continue;
    const std::vector<double> values = number_attribute(object, candidate.name);
    if (values.size() == 1 && candidate.one_for_all) return FoundPlace{{values[0], values[0], values[0]}, &candidate};
    if (values.size() != 3) continue;
    Triple ordered{values[0], values[1], values[2]};
    if (candidate.is_ambiguous && are_extents(ordered, axes)) continue;
    if (!candidate.slowest_first) std::reverse(ordered.begin(), ordered.end());
    return FoundPlace{ordered, &candidate};
  }
  return std::nullopt;
}

void fill_places(hid_t dataset, std::span<const Hdf5Handle> groups, std::span<const PlainName> names,
                 std::span<AxisPlace> axes, PlacedMember place, SourceMember from) {
  auto found = found_in(dataset, true, names, axes);
  std::string where;
  for (std::size_t i = 0; i < groups.size() && !found; ++i) {
    found = found_in(groups[i].get(), false, names, axes);
    where = " of a group around it";
  }
  if (!found) return;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    // An axis with a note has other coordinates, or its coordinates are taken as indices.
    if (axes[i].*place || axes[i].is_time || !axes[i].note.empty()) continue;
    axes[i].*place = found->values.at(i);
    axes[i].*from = cat("attribute ", found->name->name, where);
    if (found->name->is_convention) {
      axes[i].spacing_note = cat("its spacing is that of the ", axes[i].*from, "; --spacing sets another");
    }
  }
}

}  // namespace

void place_by_attributes(hid_t dataset, std::span<const Hdf5Handle> groups, std::span<AxisPlace> axes) {
  if (axes.size() < 3) return;
  fill_places(dataset, groups, kSpacings, axes.last(3), &AxisPlace::spacing, &AxisPlace::spacing_from);
  fill_places(dataset, groups, kOrigins, axes.last(3), &AxisPlace::origin, &AxisPlace::origin_from);
}

}  // namespace weir
