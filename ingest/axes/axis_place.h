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
  std::string label;                     ///< empty where the file has no name for it
  std::optional<double> spacing;         ///< world units per element
  std::optional<double> origin;          ///< world position of element 0; of the last one where it `falls`
  std::string note;                      ///< what spacing and origin do not say of the coordinates; else empty
  std::string units = {};                ///< of the coordinates; else empty
  std::vector<double> coordinates = {};  ///< of all elements, of a time and where they are not equally spaced
  bool is_time = false;
  std::string calendar = {};     ///< of a time
  bool has_coordinates = false;  ///< the file has a dataset of them
  /// AxisPlacement::orientation of the axes together; else empty.
  std::string orientation = {};
  bool falls = false;             ///< they are equally spaced, and the last one is the lowest
  std::string spacing_from = {};  ///< what of the file says the spacing, "attribute resolution"; empty: coordinates
  std::string origin_from = {};   ///< the same of the origin
  std::string spacing_note = {};  ///< that it is by an attribute which programs may mean otherwise; else empty
  bool points_down = false;       ///< CF's attribute `positive` says that they rise downwards, as depths do
  bool grows = false;             ///< its dimension may without limit, as NetCDF's does
  /// How many elements more its dimension has, which grows and of which the file has none here: NetCDF writes a
  /// variable up to its own last record.
  std::int64_t unwritten = 0;
};

/// "Time=4 x bottom_top=14 x 48 x 48".
std::string axes_text(std::span<const AxisPlace> axes);

/// Which of `axes` are shorter than their dimensions are, and what positions count; else empty.
std::string unwritten_note(std::span<const AxisPlace> axes);

}  // namespace weir
