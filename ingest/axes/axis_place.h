// One axis of an array: its name and where its elements lie.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace weir {

/// One axis: element i lies at origin + i * spacing.
struct AxisPlace {
  std::int64_t extent = 0;               ///< elements
  std::string label;                     ///< empty if the file has no name for it
  std::optional<double> spacing;         ///< world units per element
  std::optional<double> origin;          ///< world position of element 0, or of the last element if it `falls`
  std::string note;                      ///< what spacing and origin do not say about the coordinates; else empty
  std::string units = {};                ///< units of the coordinates; else empty
  std::vector<double> coordinates = {};  ///< of all elements; kept for a time axis and if they are not equally spaced
  bool is_time = false;
  std::string calendar = {};     ///< calendar of a time axis
  bool has_coordinates = false;  ///< the file has a dataset of coordinates
  /// AxisPlacement::orientation of all axes together; else empty.
  std::string orientation = {};
  bool falls = false;             ///< the coordinates are equally spaced, and the last is the lowest
  std::string spacing_from = {};  ///< where the file gives the spacing, "attribute resolution"; empty: coordinates
  std::string origin_from = {};   ///< where the file gives the origin
  std::string spacing_note = {};  ///< note that other programs may read the spacing's attribute otherwise; else empty
  bool points_down = false;  ///< CF's attribute `positive` says that the coordinates increase downwards, as depths do
  bool grows = false;        ///< its dimension is unlimited, as NetCDF's can be
  /// How many more elements the axis's growing dimension has than this variable. NetCDF writes each variable only up
  /// to its own last record.
  std::int64_t unwritten = 0;
};

/// Returns the axes as "Time=4 x bottom_top=14 x 48 x 48".
std::string axes_text(std::span<const AxisPlace> axes);

/// Returns which of `axes` are shorter than their dimensions, and which positions count. Otherwise returns "".
std::string unwritten_note(std::span<const AxisPlace> axes);

}  // namespace weir
