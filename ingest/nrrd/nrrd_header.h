// The header of an NRRD file, "nearly raw raster data": Teem's text header before
// or beside the values (https://teem.sourceforge.net/nrrd/format.html).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "format/base/scalar_type.h"

namespace weir {

inline constexpr std::string_view kNrrdMagic = "NRRD000";

/// What the header says, checked for itself but not against any file. Vectors of one entry per axis are as long as
/// `sizes`, or empty where the header lacks the field; the fastest axis comes first.
struct NrrdHeader {
  std::size_t header_bytes = 0;  ///< up to the first byte after the blank line, or to the end
  ScalarType type = ScalarType::float32;
  bool big_endian = false;
  bool gzip = false;                ///< encoding gzip, else raw
  std::vector<std::int64_t> sizes;  ///< as they stand, at least one, perhaps below 1
  std::string data_file;            ///< as written; empty: the values follow the header
  std::uint64_t line_skip = 0;      ///< lines of the data file before the (packed) values
  std::uint64_t byte_skip = 0;      ///< after those, of the unpacked data
  bool at_end = false;              ///< byte skip -1: the values are the file's last bytes

  std::vector<std::string> kinds;  ///< lower case
  std::vector<std::string> labels;
  std::vector<std::string> units;  ///< "mm"; of an axis without a direction
  std::vector<double> spacings;    ///< NaN: none along this axis
  std::vector<double> axis_mins;   ///< NaN: unknown
  std::vector<double> axis_maxs;
  std::vector<std::string> centerings;                         ///< lower case
  std::vector<std::optional<std::vector<double>>> directions;  ///< world steps; nullopt: not an axis of space
  std::vector<double> space_origin;                            ///< empty: none
  std::vector<std::string> space_units;                        ///< of the world's axes, as many as it has; or empty
  std::string sample_units;
};

/// Parses the header that `text` begins with; `whole` tells that the text is all of the file, so that a detached
/// header may end with it. Pure. Throws Error(input), beginning with `path`, naming field, line and value, for what
/// is no header or describes what weir does not read: other types and encodings, lists of data files.
NrrdHeader parse_nrrd_header(std::string_view text, bool whole, const std::string& path);

}  // namespace weir
