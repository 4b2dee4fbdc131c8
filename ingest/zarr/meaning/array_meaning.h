// The meaning of a Zarr array as a volume: its axes, the places of its voxels, and the meaning of its values.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ingest/axes/axis_details.h"
#include "ingest/axes/component_axis.h"
#include "ingest/source/component_choice.h"
#include "ingest/source/index_choice.h"
#include "ingest/source/volume_source.h"
#include "ingest/zarr/meaning/array_axes.h"
#include "ingest/zarr/meaning/array_values.h"
#include "ingest/zarr/meaning/coordinate_arrays.h"
#include "ingest/zarr/metadata/zarr_array.h"

namespace weir {

struct ArrayMeaning {
  ArrayAxes axes;
  std::optional<TimeValues> auxiliary_time;
  ArrayValues values;
  ComponentAxis components;  ///< the axis that --component chooses on
  std::string obstacle;      ///< why the array is no volume; empty if it is one
  bool over_time = false;    ///< the obstacle is that it is a series of planes over time

  /// Returns the end of the axes of space: before the last axis, if that has the components of each voxel.
  std::size_t end_of_space() const { return axes.places.size() - (components.found() && !components.leading ? 1 : 0); }
  /// Returns the axes before the axes of space and components. --index gives positions on them.
  std::vector<LeadingAxis> leading() const { return leading_before(components); }
  /// Returns the leading axes if `vectors` were the components.
  std::vector<LeadingAxis> leading_before(const ComponentAxis& vectors) const;
  /// Returns the last three axes before end_of_space(), x first. The array must have them.
  VolumeAxes volume_axes() const;
};

/// Returns the meaning of `array`; `axes` are its axes. An axis counts as components only if there is no doubt
/// (component_axis).
ArrayMeaning array_meaning(const ZarrArray& array, ArrayAxes axes);

/// Sets the components of `meaning`, the meaning of `array`, to the axis that `choice` refers to. `positions` is the
/// number of positions in --index. Throws the errors of chosen_component_axis, beginning with `where`.
void choose_component(const ZarrArray& array, const std::optional<ComponentChoice>& choice, std::size_t positions,
                      const std::string& where, ArrayMeaning& meaning);

/// Returns the positions on the leading axes: `index`, or 0 on each axis if `index` is empty and each has one element
/// only. Throws Error(usage), beginning with `where`, if they do not fit the axes.
std::vector<std::int64_t> checked_index(const ArrayMeaning& meaning, const std::vector<std::int64_t>& index,
                                        const std::string& where);

/// Sets extent, spacing, origin, labels, units and the other descriptions of `meaning` in `info`.
void describe_volume(const ZarrArray& array, const ArrayMeaning& meaning, const std::vector<std::int64_t>& index,
                     SourceInfo& info);

}  // namespace weir
