// Where the elements of an array lie, by the arrays beside it that are called as its axes are: as xarray writes the
// coordinates of NetCDF and CF.
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

/// Reads coordinates, and keeps what was made of them: the arrays of one group share them. One thread at a time.
class CoordinateArrays {
 public:
  /// `store` outlives it.
  explicit CoordinateArrays(ZarrStore& store) : store_(store) {}

  /// Gives `axes`, those of the array at `key` by their names, the units, places, times and notes that arrays of one
  /// axis say which are called so and have as many elements: in the array's group, or else in the nearest group around
  /// it. Throws Error(input) where their values are damaged; those that cannot be understood get a note.
  void place(const std::string& key, std::span<AxisPlace> axes);

  /// The first that attribute `coordinates` (CF 5) of the array at `key` names, of units "... since ...", which can be
  /// read and is a single one, or one for each element of an axis of time among `axes`. nullopt where it names none.
  std::optional<TimeValues> auxiliary_time(const std::string& key, const nlohmann::json& attributes,
                                           std::span<const AxisPlace> axes);

 private:
  const AxisPlace& placed(const ZarrNode& found, const AxisPlace& axis);

  ZarrStore& store_;
  std::map<std::string, AxisPlace> placed_;  ///< by the key of the array of coordinates
  std::size_t kept_ = 0;                     ///< coordinates in them
  std::map<std::string, TimeValues> times_;
};

}  // namespace weir
