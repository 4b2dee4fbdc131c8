// What a Zarr array is as a volume: its axes, where its voxels lie, what its values mean.
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
  std::string obstacle;      ///< why it is no volume; empty where it is one
  bool over_time = false;    ///< the obstacle is that a time is among its axes of space

  /// Where its axes of space end: before the components that each voxel has, where there are some.
  std::size_t end_of_space() const { return axes.places.size() - (components.found() && !components.leading ? 1 : 0); }
  /// Those before the axes of space, and components, which --index takes positions on.
  std::vector<LeadingAxis> leading() const { return leading_before(components); }
  /// The same where `vectors` are the components.
  std::vector<LeadingAxis> leading_before(const ComponentAxis& vectors) const;
  /// The last three before end_of_space(), of an array that has them.
  VolumeAxes volume_axes() const;
};

/// `axes` are the array's. Its components are those that it has without doubt (component_axis).
ArrayMeaning array_meaning(const ZarrArray& array, ArrayAxes axes);

/// Sets the components of `meaning`, that of `array`, to those that `choice` is of, `positions` being those of --index.
/// Throws what chosen_component_axis throws, beginning with `where`.
void choose_component(const ZarrArray& array, const std::optional<ComponentChoice>& choice, std::size_t positions,
                      const std::string& where, ArrayMeaning& meaning);

/// The positions on the leading axes: those that `index` gives, or 0 on each where each has one element alone. Throws
/// Error(usage), beginning with `where`, where they do not fit.
std::vector<std::int64_t> checked_index(const ArrayMeaning& meaning, const std::vector<std::int64_t>& index,
                                        const std::string& where);

/// Puts extent, spacing, origin, labels, units and what else `meaning` says into `info`.
void describe_volume(const ZarrArray& array, const ArrayMeaning& meaning, const std::vector<std::int64_t>& index,
                     SourceInfo& info);

}  // namespace weir
