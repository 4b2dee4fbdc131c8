// The positions of an array's elements, from the coordinate arrays beside it that have its axes' names: xarray writes
// the coordinates of NetCDF and CF this way.
#pragma once

#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>

#include "ingest/axes/axis_place.h"
#include "ingest/axes/volume_time.h"
#include "ingest/zarr/meaning/zarr_nodes.h"
#include "ingest/zarr/store/zarr_store.h"

namespace weir {

/// Reads coordinate arrays and keeps the results, because the arrays of a group share coordinates. For one thread at
/// a time.
class CoordinateArrays {
 public:
  /// `store` must outlive this object.
  explicit CoordinateArrays(ZarrStore& store) : store_(store) {}

  /// Sets units, places, times and notes of `axes`, the axes of the array at `key`, from coordinate arrays. A
  /// coordinate array has one axis, the axis's name and as many elements. It lies in the array's group, or otherwise
  /// in the nearest group around it. Throws Error(input) if its values are damaged. Coordinates that cannot be
  /// understood add a note.
  void place(const std::string& key, std::span<AxisPlace> axes);

  /// Returns an auxiliary time of the array at `key`: the first array that its attribute `coordinates` (CF 5) names,
  /// that has units "... since ..." and can be read. It must have a single element, or one for each element of a time
  /// axis among `axes`. Returns nullopt if there is none.
  std::optional<TimeValues> auxiliary_time(const std::string& key, const nlohmann::json& attributes,
                                           std::span<const AxisPlace> axes);

 private:
  const AxisPlace& placed(const ZarrNode& found, const AxisPlace& axis);

  ZarrStore& store_;
  std::map<std::string, AxisPlace> placed_;  ///< by the key of the coordinate array
  std::size_t kept_ = 0;                     ///< number of coordinates in placed_
  std::map<std::string, TimeValues> times_;
};

}  // namespace weir
