// A source for a dense array in the caller's memory. It copies only what is read.
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

/// The voxels of an array in memory, in this machine's byte order and at any alignment. `data` must stay readable and
/// unchanged as long as a source of it exists.
struct DenseArray {
  const void* data = nullptr;                ///< voxel (0, 0, 0)
  ScalarType type = ScalarType::float32;     ///< of each voxel
  Index3 extent;                             ///< voxels, each >= 1 and < 2^31
  std::array<std::int64_t, 3> stride{};      ///< bytes from one voxel to the next along x, y, z; any value, also <= 0
  std::array<double, 3> spacing{1, 1, 1};    ///< world units per voxel, > 0
  std::array<double, 3> origin{0, 0, 0};     ///< world position of the centre of voxel (0, 0, 0)
  std::string name{};                        ///< name of the quantity, becomes the grid's; may be empty
  std::vector<StoredValue> missing{};        ///< values that mean "no data"
  bool keeps_missing = false;                ///< the `missing` values are taken as data
  std::string units{};                       ///< units of the values; may be empty
  std::array<std::string, 3> axis_labels{};  ///< of x, y, z; empty if they have none
  FieldDetails details{};                    ///< for the sidecar
};

/// Returns the strides in bytes of an array without gaps, x fastest: Fortran's a(x, y, z), C's a[z][y][x].
std::array<std::int64_t, 3> packed_stride(const Index3& extent, ScalarType type);

/// Throws Error(usage), beginning with `path`, if the strides of `extent` voxels lead out of the address space.
void check_strides(std::string_view path, const Index3& extent, const std::array<std::int64_t, 3>& stride);

/// Returns the info of a source of `array`. Looks at neither data nor strides. info().mtime_ns is the time of this
/// call. Throws Error(input) if the extent is impossible, Error(usage) if spacing or origin are invalid, or if the
/// type cannot hold a missing value.
SourceInfo array_info(const DenseArray& array);

/// Returns a source that reads `array` in place. A conversion of it cannot be continued, so ConversionOptions::resume
/// must be off. Throws what array_info throws, and Error(usage) if data is null or the strides lead out of the
/// address space.
std::unique_ptr<VolumeSource> open_array(const DenseArray& array);

}  // namespace weir
