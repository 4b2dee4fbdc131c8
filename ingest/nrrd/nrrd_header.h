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

/// The contents of the header, checked for consistency but not against any file. A vector with one entry per axis is
/// as long as `sizes`, or empty if the header lacks the field; the fastest axis comes first.
struct NrrdHeader {
  std::size_t header_bytes = 0;  ///< offset of the first byte after the blank line, or of the text's end
  ScalarType type = ScalarType::float32;
  bool big_endian = false;
  bool gzip = false;                ///< encoding gzip; false: raw
  std::vector<std::int64_t> sizes;  ///< as written, at least one entry; an entry may be below 1
  std::string data_file;            ///< as written; empty: the values follow the header
  std::uint64_t line_skip = 0;      ///< lines of the data file before the (packed) values
  std::uint64_t byte_skip = 0;      ///< bytes after these lines, in the unpacked data
  bool at_end = false;              ///< byte skip -1: the values are the file's last bytes

  std::vector<std::string> kinds;  ///< lower case
  std::vector<std::string> labels;
  std::vector<std::string> units;  ///< "mm"; for axes without a direction
  std::vector<double> spacings;    ///< NaN: none along this axis
  std::vector<double> axis_mins;   ///< NaN: unknown
  std::vector<double> axis_maxs;
  std::vector<std::string> centerings;                         ///< lower case
  std::vector<std::optional<std::vector<double>>> directions;  ///< world steps; nullopt: not an axis of space
  std::vector<double> space_origin;                            ///< empty: none
  std::vector<std::string> space_units;                        ///< of the world's axes, one for each; may be empty
  std::string sample_units;
};

/// Parses the header at the beginning of `text`; `whole` says that `text` is the whole file, so that a detached
/// header may end with it. Pure. Throws Error(input), beginning with `path` and naming field, line and value, if
/// `text` is not a header or describes something that weir does not read: other types and encodings, or lists of data
/// files.
NrrdHeader parse_nrrd_header(std::string_view text, bool whole, const std::string& path);

}  // namespace weir
