// The naming pattern of raw volumes, NAME_XxYxZ_TYPE.raw, as the Open SciVis data sets use it:
// "aneurism_256x256x256_uint8.raw". TYPE is any type that --type takes: "float", "f4", ">u2". A "be" after the type
// says that values are big-endian: "carotid_76x49x45_float32be.raw". The extension may be in capitals.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "format/base/index.h"
#include "format/base/scalar_type.h"

namespace weir {

struct RawName {
  std::string name;                ///< the part before the extent
  Index3 extent;                   ///< voxels as written, not checked; numbers too long for 64 bits are clamped
  std::string type_text;           ///< the type as written, "be" included
  std::optional<ScalarType> type;  ///< empty if type_text names no type of weir
  bool big_endian = false;         ///< the name has "be" or ">"; without them it says nothing about the byte order
};

/// Reads the last component of `path`. Returns nullopt if it does not follow the pattern.
std::optional<RawName> parse_raw_name(std::string_view path);

}  // namespace weir
