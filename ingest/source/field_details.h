// What a file says of a volume besides values and place: kept in the sidecar, used by no computation.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace weir {

/// A point of time, as the file counts it.
struct TimePoint {
  double value = 0;
  std::string units;     ///< "seconds since 2000-01-01", "s"; else empty
  std::string calendar;  ///< of CF: "noleap", ...; else empty
};

/// One axis of a volume.
struct AxisDetails {
  std::string units;                ///< of its coordinates, "km"; else empty
  std::vector<double> coordinates;  ///< of index 0, 1, ... where they are not equally spaced; else empty
  std::string note;                 ///< what the volume's spacing and origin do not say of them; else empty
  bool reversed = false;            ///< the file has the elements in the other order, by falling coordinates
};

/// One of several levels of refinement.
struct RefinementLevel {
  std::int64_t number = 0;  ///< 0 the coarsest
  std::int64_t count = 1;   ///< how many there are
};

struct FieldDetails {
  std::string long_name;                 ///< "cloud water mixing ratio"; else empty
  std::string component;                 ///< of an array of vectors: component_text(); else empty
  std::string levels;                    ///< of levels of refinement: which make the volume, and how; else empty
  std::optional<RefinementLevel> level;  ///< where one alone makes the volume
  std::optional<TimePoint> time;         ///< at which the volume is
  std::array<AxisDetails, 3> axes;       ///< x, y, z
  std::string order_note;                ///< where the file names its axes in another order than z, y, x; else empty
  std::string orientation;               ///< AxisPlacement::orientation, where weir does not keep it; else empty
  bool points_down = false;              ///< orientation says that an axis points down: all else is as in the file
  std::string values_note;               ///< what the file says of its values and weir does not apply, and of a
                                         ///< spacing that an attribute of no one meaning says or that is no place;
                                         ///< else empty
  std::string data_note;                 ///< which bytes of a header's values' file are not read; else empty
  std::string chunks_note;               ///< how many chunks are not stored, and what they read as; else empty
  std::string units_note;                ///< which axis is in which units, where spacings are in several; else empty
};

}  // namespace weir
