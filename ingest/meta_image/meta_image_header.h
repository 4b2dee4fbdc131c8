// The text header of MetaImage, ITK's own format (.mha, .mhd):
// https://itk.org/Wiki/ITK/MetaIO/Documentation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "format/base/scalar_type.h"

namespace weir {

/// The beginning of keys that describe one frame of a sequence (PLUS, SlicerIGT). weir ignores these keys.
inline constexpr std::string_view kFrameKey = "Seq_Frame";

/// The contents of the header, checked for consistency but not against any file. A vector is empty if the header
/// lacks its key; x comes first.
struct MetaImageHeader {
  std::size_t header_bytes = 0;  ///< offset of the first byte after the line of ElementDataFile
  ScalarType type = ScalarType::float32;
  bool big_endian = false;
  bool compressed = false;             ///< zlib
  std::uint64_t compressed_bytes = 0;  ///< 0: not stated
  std::uint64_t header_size = 0;       ///< bytes before the values in their file; 0: none, or after a local header
  bool at_end = false;                 ///< HeaderSize -1: the values are the file's last bytes
  std::vector<std::int64_t> dim_size;  ///< NDims entries, at least one; an entry may be below 1
  std::string data_file;               ///< as written; empty: LOCAL, the values follow the header

  std::vector<double> spacing;    ///< ElementSpacing, or ElementSize if that is absent
  std::vector<double> origin;     ///< Offset, also called Origin and Position
  std::vector<double> transform;  ///< NDims x NDims: row a is the direction of axis a
  std::string distance_units;     ///< DistanceUnits, of spacing and origin: "mm"; empty if unknown
  double slope = 1;               ///< ElementToIntensityFunctionSlope
  double offset = 0;              ///< ElementToIntensityFunctionOffset
};

/// Parses the header at the beginning of `text`; `whole` says that `text` is the whole file. Pure. Throws
/// Error(input), beginning with `path` and naming key, line and value, if `text` is not a header or describes
/// something that weir does not read: channels, values as text, or lists of data files.
MetaImageHeader parse_meta_image_header(std::string_view text, bool whole, const std::string& path);

}  // namespace weir
