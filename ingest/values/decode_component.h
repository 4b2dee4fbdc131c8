// Decodes voxels of several numbers each, which follow each other, to one value per voxel.
#pragma once

#include <cstddef>
#include <span>

#include "format/base/scalar_type.h"
#include "ingest/source/component_choice.h"
#include "ingest/source/stored_value.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Decodes `values.size()` voxels of components.count numbers of `type` each from `bytes`, which holds exactly these.
/// One component: its numbers are decoded as decode_values does. The magnitude: sqrt(sum of squares) in double, of
/// the numbers after `mapping` in double, in the order of the components, rounded to float32; its loss is counted
/// against the double. If a component is missing, the voxel is missing_value(), unless `mapping` keeps missing values
/// as data, which counts the voxel as unmarked. If a component is NaN, the voxel is one fixed NaN.
ConversionLoss decode_component(std::span<const std::byte> bytes, ScalarType type, bool big_endian,
                                const ValueMapping& mapping, const VoxelComponents& components,
                                std::span<float> values);

}  // namespace weir
