// What a file says about a volume besides values and place. The sidecar keeps it; no computation uses it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace weir {

/// A point in time, as the file counts it.
struct TimePoint {
  double value = 0;
  std::string units;     ///< "seconds since 2000-01-01", "s"; else empty
  std::string calendar;  ///< CF calendar ("noleap", ...); else empty
};

/// One axis of a volume.
struct AxisDetails {
  std::string units;                ///< units of its coordinates ("km"); else empty
  std::vector<double> coordinates;  ///< of index 0, 1, ... if they are not equally spaced; else empty
  std::string note;       ///< what the volume's spacing and origin do not say about the coordinates; else empty
  bool reversed = false;  ///< the file stores the elements in the opposite order, by falling coordinates
};

/// One of several levels of refinement.
struct RefinementLevel {
  std::int64_t number = 0;  ///< 0 the coarsest
  std::int64_t count = 1;   ///< how many there are
};

struct FieldDetails {
  std::string long_name;  ///< "cloud water mixing ratio"; else empty
  std::string component;  ///< for an array of vectors, component_text(); else empty
  std::string levels;     ///< for levels of refinement: which of them make the volume, and how; else empty
  std::optional<RefinementLevel> level;  ///< set if a single level makes the volume
  std::optional<TimePoint> time;         ///< time of the volume
  std::array<AxisDetails, 3> axes;       ///< x, y, z
  std::string order_note;                ///< set if the file names its axes in another order than z, y, x; else empty
  std::string orientation;               ///< AxisPlacement::orientation, if weir does not keep it; else empty
  bool points_down = false;  ///< `orientation` only says that an axis points down; voxels are as in the file
  std::string values_note;   ///< notes on values and spacing: statements of the file about its values that weir does
                             ///< not apply, and spacings from an attribute that has several meanings or that give no
                             ///< valid place; else empty
  std::string data_note;     ///< which bytes of the data file that a header names are not read; else empty
  std::string chunks_note;   ///< how many chunks are not stored, and what their voxels read as; else empty
  std::string units_note;    ///< units of each axis, if the spacings have different units; else empty
};

}  // namespace weir
