// What the axes of an array are called and where its elements lie along them,
// from whatever convention the file follows.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ingest/hdf5/file/hdf5_object.h"

namespace weir {

/// One axis: element i lies at origin + i * spacing.
struct AxisPlace {
  std::int64_t extent = 0;        ///< elements
  std::string label;              ///< empty where the file has no name for it
  std::optional<double> spacing;  ///< world units per element
  std::optional<double> origin;   ///< world position of element 0
  std::string note;               ///< why there is no spacing although there are coordinates; else empty
};

/// The axes of `object`, an array of `extents`, in the file's order, slowest first: by openPMD, then by
/// NetCDF's coordinate variables, then by plain attributes; what one leaves open the next may say. The caller
/// holds Hdf5Lock.
std::vector<AxisPlace> axis_places(hid_t file, const Hdf5Object& object, std::span<const std::int64_t> extents);

/// "Time=4 x bottom_top=14 x 48 x 48".
std::string axes_text(std::span<const AxisPlace> axes);

}  // namespace weir
