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

/// No header is longer, with the four bytes behind it that tell of extensions, and without these.
inline constexpr std::size_t kMaxNiftiHeader = 544;

/// What the header says, checked for itself but not against any file.
struct NiftiHeader {
  bool big_endian = false;
  bool pair = false;                  ///< the values are in a file of their own, .img beside .hdr
  std::vector<std::int64_t> extents;  ///< x first, 1 to 7 of them, each >= 1; 0 after the third counts as 1
  ScalarType type = ScalarType::float32;
  std::uint64_t values_offset = 0;     ///< bytes before the values in their file
  bool has_hidden_extensions = false;  ///< extensions follow the header, and values_offset leaves no room for them
  double slope = 1;                    ///< value = stored * slope + intercept
  double intercept = 0;
  Vector3 spacing{1.0, 1.0, 1.0};  ///< pixdim, > 0
  std::array<Vector3, 3> steps{};  ///< world step along x, y, z: by the sform, else the qform, else pixdim
  Vector3 first{};                 ///< world position of the first voxel, x right, y anterior, z superior
  bool steps_rule = false;         ///< by the sform: the steps' lengths, not pixdim, are the spacing
  /// Which of these the header has and is no place, and what stands in: "its sform has a column that is zero or not
  /// finite; the place is that of the qform"; else empty.
  std::string placement_note;
  std::string_view length_unit;  ///< "m", "mm", "um"; empty where unknown
  std::string_view time_unit;    ///< of the fourth axis, "s", "ms", "us"; empty where it is no time
  double time_offset = 0;        ///< of the first volume, in `time_unit`
  double time_step = 0;          ///< from volume to volume along the fourth axis
};

/// Whether a file begins as NIfTI or Analyze does: with the header's size, in either byte order.
bool begins_like_nifti(std::span<const std::byte> head);

/// Parses the header that `bytes`, the first kMaxNiftiHeader of the file or all of it, begin with. Pure. Throws
/// Error(input), beginning with `path`, naming field, byte and value, for what is no header or has a type that is no
/// scalar weir reads.
NiftiHeader parse_nifti_header(std::span<const std::byte> bytes, const std::string& path);

}  // namespace weir
