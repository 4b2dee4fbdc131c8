// The binary header of NIfTI-1 and NIfTI-2, neuroimaging's format:
// https://nifti.nimh.nih.gov/pub/dist/src/niftilib/nifti1.h and nifti2.h.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "format/base/scalar_type.h"
#include "ingest/values/axis_placement.h"

namespace weir {

/// The longest header, including the four bytes after it that announce extensions.
inline constexpr std::size_t kMaxNiftiHeader = 544;

/// The contents of the header, checked for consistency but not against any file.
struct NiftiHeader {
  bool big_endian = false;
  bool pair = false;                  ///< the values are in a separate file, .img beside .hdr
  std::vector<std::int64_t> extents;  ///< x first, 1 to 7 of them, each >= 1; a 0 after the third counts as 1
  ScalarType type = ScalarType::float32;
  std::uint64_t values_offset = 0;     ///< bytes before the values in their file
  bool has_hidden_extensions = false;  ///< extensions follow the header, and values_offset leaves no room for them
  double slope = 1;                    ///< value = stored * slope + intercept
  double intercept = 0;
  Vector3 spacing{1.0, 1.0, 1.0};  ///< pixdim, > 0
  std::array<Vector3, 3> steps{};  ///< world step along x, y, z: from the sform, else the qform, else pixdim
  Vector3 first{};                 ///< world position of the first voxel, x right, y anterior, z superior
  bool steps_rule = false;         ///< the sform is used: the lengths of steps, not pixdim, are the spacing
  /// Names the sform or qform that the header has but that is not usable, and the one used instead: "its sform has a
  /// column that is zero or not finite; the place is that of the qform". Otherwise empty.
  std::string placement_note;
  std::string_view length_unit;  ///< "m", "mm", "um"; empty if unknown
  std::string_view time_unit;    ///< of the fourth axis, "s", "ms", "us"; empty if it is not a time
  double time_offset = 0;        ///< of the first volume, in `time_unit`
  double time_step = 0;          ///< from one volume to the next along the fourth axis
};

/// Returns whether a file begins like NIfTI or Analyze: with the header's size, in either byte order.
bool begins_like_nifti(std::span<const std::byte> head);

/// Parses the header at the beginning of `bytes`, which are the file's first kMaxNiftiHeader bytes or the whole file.
/// Pure. Throws Error(input), beginning with `path` and naming field, byte and value, if `bytes` are not a header or
/// the type is not a scalar that weir reads.
NiftiHeader parse_nifti_header(std::span<const std::byte> bytes, const std::string& path);

}  // namespace weir
