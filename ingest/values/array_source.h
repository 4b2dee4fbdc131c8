// A dense array in the caller's memory, as a source: nothing is copied but what is read.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "format/base/index.h"
#include "format/base/scalar_type.h"
#include "ingest/source/field_details.h"
#include "ingest/source/stored_value.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Where the voxels of an array are, in this machine's byte order and at any alignment. `data` must stay
/// readable and unchanged for as long as a source of it exists.
struct DenseArray {
  const void* data = nullptr;                ///< voxel (0, 0, 0)
  ScalarType type = ScalarType::float32;     ///< of each voxel
  Index3 extent;                             ///< voxels, each >= 1 and < 2^31
  std::array<std::int64_t, 3> stride{};      ///< bytes from one voxel to the next along x, y, z; any, also <= 0
  std::array<double, 3> spacing{1, 1, 1};    ///< world units per voxel, > 0
  std::array<double, 3> origin{0, 0, 0};     ///< world position of the centre of voxel (0, 0, 0)
  std::string name{};                        ///< of the quantity, becomes the grid's; may be empty
  std::vector<StoredValue> missing{};        ///< values that stand for "no data"
  bool keeps_missing = false;                ///< they are taken as data
  std::string units{};                       ///< of the values; may be empty
  std::array<std::string, 3> axis_labels{};  ///< of x, y, z; empty where they have none
  FieldDetails details{};                    ///< for the sidecar
};

/// The strides of an array without gaps, x fastest: Fortran's a(x, y, z), C's a[z][y][x].
std::array<std::int64_t, 3> packed_stride(const Index3& extent, ScalarType type);

/// Throws Error(usage), which begins with `path`, where these strides of `extent` voxels lead out of the address space.
void check_strides(std::string_view path, const Index3& extent, const std::array<std::int64_t, 3>& stride);

/// What a source of `array` says of it; neither data nor strides are looked at. info().mtime_ns is the time of this
/// call. Throws Error(input) where the extent is impossible, Error(usage) where spacing or origin are no place, or a
/// missing value is none of the type.
SourceInfo array_info(const DenseArray& array);

/// A source that reads `array` where it is. A conversion of it cannot be continued (ConversionOptions::resume is to be
/// off). Throws what array_info throws, and Error(usage) where data is null or the strides lead out of the address
/// space.
std::unique_ptr<VolumeSource> open_array(const DenseArray& array);

}  // namespace weir
