// Voxels of several numbers each, one after the other, to one value each.
#pragma once

#include <cstddef>
#include <span>

#include "format/base/scalar_type.h"
#include "ingest/source/component_choice.h"
#include "ingest/source/stored_value.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// `values.size()` voxels of components.count numbers of `type` each, from `bytes`, which holds exactly those. One
/// component: what decode_values makes of its numbers alone. The magnitude: sqrt(sum of squares) in double, of the
/// numbers after `mapping` in double, in the order of the components, rounded to float32; its loss is counted against
/// the double; missing_value() where a component is missing, unless `mapping` keeps those as data, which counts the
/// voxel as unmarked; one and the same NaN where one is NaN.
ConversionLoss decode_component(std::span<const std::byte> bytes, ScalarType type, bool big_endian,
                                const ValueMapping& mapping, const VoxelComponents& components,
                                std::span<float> values);

}  // namespace weir
