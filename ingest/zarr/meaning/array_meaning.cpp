#include "ingest/zarr/meaning/array_meaning.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/axes/volume_time.h"
#include "ingest/source/extent.h"

namespace weir {
namespace {

constexpr std::size_t kSpaceRank = 3;

std::string shape_obstacle(const ZarrArray& array, const ArrayMeaning& meaning) {
  const ArrayAxes& axes = meaning.axes;
  const std::size_t rank = array.shape.size();
  if (rank < kSpaceRank) {
    return rank == 0 ? "a single value; a volume has three axes"
                     : cat(rank, rank == 1 ? " axis (" : " axes (", axes.text(), "); a volume has three");
  }
  if (std::count(array.shape.begin(), array.shape.end(), 0) > 0) return cat("empty: ", axes.text());
  const auto is_other = [](const std::string& type) { return !type.empty() && type != "space" && type != "time"; };
  const std::size_t end = meaning.end_of_space();
  const auto types = std::span(axes.types).first(end).last(kSpaceRank);
  const auto others = std::count_if(types.begin(), types.end(), is_other);
  if (others == 0) {
    const std::size_t numbers = end == rank ? 1 : static_cast<std::size_t>(array.shape.back());
    return extent_obstacle({array.shape[end - 1], array.shape[end - 2], array.shape[end - 3]},
                           numbers * scalar_bytes(array.type));
  }
  return cat(static_cast<std::int64_t>(kSpaceRank) - others, " axes of space at its end (", axes.text(),
             "); a volume has three");
}

// A series of planes over time must not pass for a volume, with its time steps as a spacing.
void find_time_obstacle(ArrayMeaning& meaning) {
  const VolumeAxes last = meaning.volume_axes();
  const auto times = std::count_if(last.begin(), last.end(), [](const AxisPlace* axis) { return axis->is_time; });
  if (times == 0) return;
  const auto axes = std::span(meaning.axes.places).first(meaning.end_of_space());
  const auto others = std::count_if(axes.begin(), axes.end(), [](const AxisPlace& axis) { return !axis.is_time; });
  meaning.over_time = others < static_cast<std::ptrdiff_t>(kSpaceRank);
  meaning.obstacle = meaning.over_time
                         ? cat(static_cast<std::int64_t>(kSpaceRank) - times, " axes of space and a time at its end (",
                               meaning.axes.text(), "); a volume has three of space")
                         : cat("its time does not come before its axes of space (", meaning.axes.text(),
                               "); write it with the time as the first axis");
}

void find_obstacle(const ZarrArray& array, ArrayMeaning& meaning) {
  meaning.over_time = false;
  meaning.obstacle = shape_obstacle(array, meaning);
  if (meaning.obstacle.empty()) meaning.obstacle = meaning.values.obstacle;
  if (meaning.obstacle.empty()) find_time_obstacle(meaning);
}

}  // namespace

std::vector<LeadingAxis> ArrayMeaning::leading_before(const ComponentAxis& vectors) const {
  std::vector<LeadingAxis> leading;
  const std::size_t behind = kSpaceRank + (vectors.found() ? 1 : 0);  // space and components, in either order
  for (std::size_t axis = 0; axis + behind < axes.places.size(); ++axis) {
    leading.push_back({axes.places[axis].label, axes.places[axis].extent});
  }
  return leading;
}

VolumeAxes ArrayMeaning::volume_axes() const {
  const std::size_t end = end_of_space();
  return {&axes.places[end - 1], &axes.places[end - 2], &axes.places[end - 3]};
}

ArrayMeaning array_meaning(const ZarrArray& array, ArrayAxes axes) {
  ArrayMeaning meaning{std::move(axes), {}, array_values(array), {}, {}, false};
  meaning.components = component_axis(meaning.axes.places);
  find_obstacle(array, meaning);
  return meaning;
}

void choose_component(const ZarrArray& array, const std::optional<ComponentChoice>& choice, std::size_t positions,
                      const std::string& where, ArrayMeaning& meaning) {
  const std::string said = cat(where, ": its axes are ", meaning.axes.text());
  meaning.components = chosen_component_axis(meaning.axes.places, positions, said, choice);
  find_obstacle(array, meaning);
}

std::vector<std::int64_t> checked_index(const ArrayMeaning& meaning, const std::vector<std::int64_t>& index,
                                        const std::string& where) {
  const std::vector<LeadingAxis> leading = meaning.leading();
  const bool single =
      std::all_of(leading.begin(), leading.end(), [](const LeadingAxis& axis) { return axis.extent == 1; });
  if (index.empty() && single) return std::vector<std::int64_t>(leading.size(), 0);
  const auto refuse = [&](const Message& found) {
    std::string ranges;
    for (std::size_t axis = 0; axis < leading.size(); ++axis) {
      ranges +=
          cat(ranges.empty() ? "" : ", ", axis_name(leading[axis].name, axis), " in 0..", leading[axis].extent - 1);
    }
    const Message remedy = leading.empty() ? compose("leave ", option("index"), " out")
                                           : compose("give ", option("index"), " with ", leading.size(),
                                                     leading.size() == 1 ? " position: " : " positions: ", ranges);
    return usage_error(compose(where, ": its axes are ", meaning.axes.text(), found, "; ", remedy));
  };
  if (index.empty()) throw refuse(", and a volume has three");
  if (index.size() != leading.size()) {
    throw refuse(
        compose(", and ", option("index"), " has ", index.size(), index.size() == 1 ? " position" : " positions"));
  }
  for (std::size_t axis = 0; axis < leading.size(); ++axis) {
    if (index[axis] >= 0 && index[axis] < leading[axis].extent) continue;
    throw refuse(compose(", and ", option("index"), " has ", index[axis]));
  }
  return index;
}

namespace {

std::optional<TimePoint> time_of(const ArrayMeaning& meaning, const std::vector<std::int64_t>& index) {
  std::vector<const AxisPlace*> leading;
  for (std::size_t i = 0; i < index.size(); ++i) leading.push_back(&meaning.axes.places[i]);
  const TimePosition position = time_position(leading, index);
  if (position.coordinate || !meaning.auxiliary_time) return position.coordinate;
  return position.in(*meaning.auxiliary_time);
}

}  // namespace

void describe_volume(const ZarrArray& array, const ArrayMeaning& meaning, const std::vector<std::int64_t>& index,
                     SourceInfo& info) {
  const VolumeAxes axes = meaning.volume_axes();
  info.extent = {axes[0]->extent, axes[1]->extent, axes[2]->extent};
  info.index = index;
  info.type = array.type;
  info.mapping = meaning.values.mapping;
  info.units = meaning.values.units;
  info.details.long_name = meaning.values.long_name;
  info.details.values_note = meaning.values.note;
  describe_axes(axes, info.details);
  for (std::size_t i = 0; i < kSpaceRank; ++i) {
    info.spacing.at(i) = axes.at(i)->spacing.value_or(1.0);
    info.origin.at(i) = axes.at(i)->origin.value_or(0.0);
    info.axis_labels.at(i) = axes.at(i)->label;
    info.spacing_from.at(i) = axes.at(i)->spacing_from;
    info.origin_from.at(i) = axes.at(i)->origin_from;
    if (!meaning.axes.note.empty()) info.details.axes.at(i).note = meaning.axes.note;
  }
  info.details.time = time_of(meaning, index);
}

}  // namespace weir
