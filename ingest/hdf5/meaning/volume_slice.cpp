#include "ingest/hdf5/meaning/volume_slice.h"

#include <algorithm>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/axes/component_axis.h"
#include "ingest/source/index_choice.h"

namespace weir {
namespace {

// "Time in 0..3, level in 0..13"
std::string ranges_text(std::span<const AxisPlace> axes, const std::vector<std::size_t>& others) {
  std::string text;
  for (const std::size_t i : others) {
    text += cat(text.empty() ? "" : ", ", axis_name(axes[i].label, i), " in 0..", axes[i].extent - 1,
                unwritten_text({axes[i].label, axes[i].extent, axes[i].unwritten}));
  }
  return text;
}

bool have_one_element_each(std::span<const AxisPlace> axes, const std::vector<std::size_t>& others) {
  return std::all_of(others.begin(), others.end(), [&](std::size_t i) { return axes[i].extent == 1; });
}

void place(std::span<const AxisPlace> axes, VolumeSlice& slice) {
  const auto axis_at = [&](std::size_t i) -> const AxisPlace& { return axes[slice.roles.volume.at(2 - i)]; };
  slice.extent = {axis_at(0).extent, axis_at(1).extent, axis_at(2).extent};
  for (std::size_t i = 0; i < kVolumeRank; ++i) {
    const AxisPlace& axis = axis_at(i);
    slice.labels[i] = axis.label;
    slice.spacing[i] = axis.spacing.value_or(1.0);
    slice.origin[i] = axis.origin.value_or(0.0);
    slice.falls[i] = axis.falls;
  }
}

}  // namespace

std::size_t leading_axes(std::span<const AxisPlace> axes) {
  if (component_axis(axes).found()) axes = axes.first(axes.size() - 1);
  if (axes.size() <= kVolumeRank) return 0;
  const std::vector<std::size_t> others = axis_roles(axes).others;
  return have_one_element_each(axes, others) ? 0 : others.size();
}

VolumeSlice volume_slice(std::span<const AxisPlace> axes, const std::vector<std::int64_t>& index,
                         const std::string& where, const std::optional<ComponentChoice>& component) {
  VolumeSlice slice;
  const std::string said = cat(where, ": its axes are ", axes_text(axes));
  const bool leading_counts = !axis_roles(axes).interleaved();
  const ComponentAxis vectors = chosen_component_axis(axes, index.size(), said, component, leading_counts);
  slice.roles = axis_roles_beside(vectors, axes);
  const std::vector<std::size_t>& others = slice.roles.others;
  const auto refuse = [&](const Message& found) {
    const Message remedy =
        others.empty() ? compose("leave ", option("index"), " out")
                       : compose("give ", option("index"), " with ", others.size(),
                                 others.size() == 1 ? " position: " : " positions: ", ranges_text(axes, others));
    return Error(ErrorKind::usage, compose(said, found, "; ", remedy));
  };
  const bool single = have_one_element_each(axes, others);
  slice.index = index.empty() && single ? std::vector<std::int64_t>(others.size(), 0) : index;
  if (slice.index.empty() && !others.empty()) throw refuse(", and a volume has three");
  if (slice.index.size() != others.size()) {
    throw refuse(
        compose(", and ", option("index"), " has ", index.size(), index.size() == 1 ? " position" : " positions"));
  }
  for (std::size_t i = 0; i < others.size(); ++i) {
    if (slice.index[i] < 0 || slice.index[i] >= axes[others[i]].extent) {
      throw refuse(compose(", and ", option("index"), " has ", slice.index[i]));
    }
  }
  slice.positions = slice.index;
  if (vectors.leading && !component->magnitude) {
    slice.positions.push_back(component->position);
  } else if (vectors.found()) {
    slice.components = {vectors.count, *component};
    slice.planar = vectors.leading;
  }
  place(axes, slice);
  return slice;
}

}  // namespace weir
