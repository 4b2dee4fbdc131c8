#include "ingest/zarr/meaning/array_axes.h"

#include <cstddef>

#include "format/base/text.h"
#include "ingest/axes/time_axis.h"

namespace weir {
namespace {

// Versions up to 0.3 have only names of axes; there "t" is the time.
bool is_time_of_image(const ScaleAxis& axis) {
  return axis.type.empty() ? axis.name == "t" || is_time_axis({axis.name, axis.unit, {}, {}, false})
                           : axis.type == "time";
}

void place_by_level(const FoundLevel& found, ArrayAxes& axes) {
  const std::size_t rank = axes.places.size();
  const ScaleLevel& level = found.image.levels[found.level];
  if (found.image.axes.size() == rank) {
    for (std::size_t axis = 0; axis < rank; ++axis) {
      const ScaleAxis& said = found.image.axes[axis];
      axes.places[axis].label = said.name;
      axes.places[axis].units = said.unit;
      axes.places[axis].is_time = is_time_of_image(said);
      axes.types[axis] = said.type;
    }
  }
  const bool fits = level.scale.size() == rank;
  for (std::size_t axis = 0; axis < rank; ++axis) {
    if (!fits && axes.places[axis].is_time) continue;  // without a scale, its index is no value of time
    axes.places[axis].spacing = fits ? level.scale[axis] : 1.0;
    axes.places[axis].origin = fits ? level.translation[axis] : 0.0;
    axes.places[axis].spacing_from = cat("coordinateTransformations in ", found.image.document);
    axes.places[axis].origin_from = axes.places[axis].spacing_from;
  }
  if (!level.placed || (!fits && !level.scale.empty())) {
    axes.note = cat("its coordinateTransformations are others than scale and translation by ",
                    level.placed ? cat(rank, " numbers, one for each axis") : "numbers", ", taken as indices");
  }
}

}  // namespace

std::string ArrayAxes::text() const {
  std::string text;
  for (const AxisPlace& axis : places) {
    text += cat(text.empty() ? "" : ", ", axis.label, axis.label.empty() ? "" : " ", axis.extent);
  }
  return text;
}

ArrayAxes array_axes(const ZarrArray& array, const std::optional<FoundLevel>& level) {
  ArrayAxes axes;
  axes.types.resize(array.shape.size());
  for (std::size_t axis = 0; axis < array.shape.size(); ++axis) {
    AxisPlace place{array.shape[axis], array.axis_names[axis], {}, {}, {}};
    place.is_time = is_time_axis({place.label, {}, {}, {}, false});
    axes.places.push_back(std::move(place));
  }
  if (level) place_by_level(*level, axes);
  return axes;
}

}  // namespace weir
